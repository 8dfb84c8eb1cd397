classdef Study < pkmopt.internal.LibraryObject
% STUDY  A design problem and its optimisers, from a study file in TOML.
%   s = pkmopt.Study('study.toml')
%   s = pkmopt.Study('study.toml', {'set r=50 mm', 'limit beta_max=50 deg', 'cells x=40'})   as --set, --limit, --cells
%   s = pkmopt.Study.fromText(toml)
%
% Designs are matrices with one row per design and one column per variable, in SI units.
%
% Properties:
%   name, variables, objectives, constraints, outputs   text, and cell rows of names
%   lower, upper     rows: ranges of the variables
%   maximise         logical row: whether each objective is maximised
%   baseline         row: the variables of the baseline; [] if there is none
%   warnings         cell row of texts
%   info             the description: units, parameters, stages, text, ..
% Methods: evaluate, differentiate, whyFailed, run, text
%
% See also pkmopt.Results, pkmopt.resume
  properties (SetAccess = private)
    info
    name
    variables
    objectives
    constraints
    outputs
    lower
    upper
    maximise
    baseline
    warnings
  end

  methods
    function self = Study(file, changes)
      if nargin == 0
        error('pkmopt:invalidInput', 'expected the name of a study file *.toml');
      elseif isa(file, 'uint64')  % an object of the library and its description
        info = changes;
        self.id = file;
      else
        if nargin < 2
          changes = {};
        end
        pkmopt.internal.require_mex();
        lines = strjoin(cellstr(changes), sprintf('\n'));
        [self.id, info] = pkmopt_mex('study_from_file', pkmopt.internal.text(file, 'file'), lines);
      end
      self.info = info;
      self.name = info.name;
      self.variables = pkmopt.internal.names(info.variables);
      self.objectives = pkmopt.internal.names(info.objectives);
      self.constraints = pkmopt.internal.names(info.constraints);
      self.outputs = pkmopt.internal.names(info.outputs);
      self.lower = zeros(1, 0);
      self.upper = zeros(1, 0);
      self.maximise = false(1, 0);
      if ~isempty(self.variables)
        self.lower = [info.variables.min];
        self.upper = [info.variables.max];
      end
      if ~isempty(self.objectives)
        self.maximise = [info.objectives.maximise];
      end
      if ~isempty(info.baseline) && ~isempty(self.variables)  % info.baseline has all parameters
        self.baseline = info.baseline([info.variables.parameter] + 1);
      end
      self.warnings = info.warnings;
    end

    function [F, G, status, outputs] = evaluate(self, X, varargin)
    % EVALUATE  Evaluates designs on all cores.
    %   [F, G, status, outputs] = s.evaluate(X)
    %   ... = s.evaluate(X, complete, threads)
    % F: values of the objectives, whether minimised or maximised; G: margins of the constraints, satisfied if >= 0;
    % outputs: values of the outputs; each has one row per design. status is a uint8 column:
    %   0  feasible
    %   1  a constraint is violated
    %   2  a constraint that depends on the design alone is violated; values that need a workspace may be NaN
    %   3  the design cannot be evaluated: NaN; s.whyFailed(x) says why
    % With complete = false (default true), the evaluation of a design may end at a violated constraint that depends on
    % the design alone, as in the optimisers.
      [F, G, status, outputs] = pkmopt_mex('study_evaluate', self.id, X, varargin{:});
    end

    function [F, G, dF, dG, status] = differentiate(self, X, varargin)
    % DIFFERENTIATE  Evaluates designs with exact derivatives by all variables.
    %   [F, G, dF, dG, status] = s.differentiate(X)
    %   ... = s.differentiate(X, threads)
    % dF: designs x objectives x variables, dG: designs x constraints x variables. For a single design they are
    % matrices, objectives x variables and constraints x variables. Derivatives of non-smooth values are those of a
    % smooth approximation. The workspace needs the method 'columns'.
      [F, G, status, ~, dF, dG] = pkmopt_mex('study_differentiate', self.id, X, [], varargin{:});
      if size(X, 1) == 1
        dF = reshape(dF, size(dF, 2), size(dF, 3));
        dG = reshape(dG, size(dG, 2), size(dG, 3));
      end
    end

    function sentence = whyFailed(self, x, varargin)
    % WHYFAILED  Why a design could not be evaluated, as one sentence; '' if it could.
    %   sentence = s.whyFailed(x)
      sentence = pkmopt_mex('study_why_failed', self.id, x, varargin{:});
    end

    function results = run(self, file, varargin)
    % RUN  Runs the study and writes its file; the results are bitwise equal to those of `pkmopt run`.
    %   results = s.run('study.h5')
    %   results = s.run('study.h5', 'seed', 2, 'overwrite', true, 'timeLimit', 60, 'threads', 4)
    % timeLimit: wall time in s after which the run stops with a checkpoint. Ctrl-C stops it with a checkpoint, too.
    % pkmopt.resume continues the run from the checkpoint.
      known = struct('seed', [], 'overwrite', false, 'timeLimit', 0, 'threads', 0);
      options = pkmopt.internal.options(known, varargin);
      file = pkmopt.internal.text(file, 'file');
      outcome = pkmopt_mex('study_run', self.id, file, options.seed, options.overwrite, options.timeLimit, ...
                           options.threads);
      results = pkmopt.Results(file, outcome);
    end

    function toml = text(self)
    % TEXT  The text of the study file.
      toml = self.info.text;
    end

    function disp(self)
      fprintf('  pkmopt.Study %s: %s; %s\n', self.name, strjoin(self.variables, ', '), strjoin(self.objectives, ', '));
    end
  end

  methods (Static)
    function s = fromText(toml, fileName, mechanism)
    % FROMTEXT  A study from the text of a study file.
    %   s = pkmopt.Study.fromText(toml)
    %   s = pkmopt.Study.fromText(toml, fileName, mechanism)
    % fileName is named in messages; mechanism, an object, is the one that the text's [mechanism] file = ".." names.
      if nargin < 2
        fileName = 'study.toml';
      end
      pkmopt.internal.require_mex();
      mechanismText = [];
      mechanismFile = [];
      if nargin > 2
        mechanismText = mechanism.text();
        mechanismFile = mechanism.fileName;
      end
      [id, info] = pkmopt_mex('study_from_text', pkmopt.internal.text(toml, 'toml'), fileName, mechanismText, ...
                              mechanismFile, []);
      s = pkmopt.Study(id, info);
    end
  end
end
