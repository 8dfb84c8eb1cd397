classdef Results < pkmopt.internal.LibraryObject
% RESULTS  The contents of a study file (HDF5).
%   r = pkmopt.Results('study.h5')
%
% Properties:
%   file, state     the file name; 'finished', 'interrupted' or 'running'
%   best            the best design: parameters, objectives, constraints, outputs by name; [] if there is none
%   stages(k)       .optimiser .rows .generations .best_row (0: none) .finished
%   variables, objectives, constraints, outputs   cell rows of names, of the columns of tables
%   outcome         of a run that has just ended: stopped, seconds, evaluations, ..
%   info            everything that `pkmopt show FILE --json` prints
% Methods: evaluations, front, population, study, report
%
% In the fields of structs, characters other than letters and digits become '_': best.objectives.workspace_volume.
%
% See also pkmopt.Study, pkmopt.resume
  properties (SetAccess = private)
    file
    info
    state
    best
    stages
    variables
    objectives
    constraints
    outputs
    outcome
  end

  methods
    function self = Results(file, outcome)
      if nargin == 0
        error('pkmopt:invalidInput', 'expected the name of a study file *.h5');
      end
      pkmopt.internal.require_mex();
      self.file = pkmopt.internal.text(file, 'file');
      [self.id, self.info, study] = pkmopt_mex('results_open', self.file);
      if nargin > 1
        self.outcome = outcome;
      end
      self.state = self.info.state;
      self.best = self.info.best;
      self.stages = self.info.tables;
      for k = 1:numel(self.stages)
        self.stages(k).best_row = self.stages(k).best_row + 1;  % rows of matrices begin with 1
      end
      if ~isempty(study)
        self.variables = pkmopt.internal.names(study.variables);
        self.objectives = pkmopt.internal.names(study.objectives);
        self.constraints = pkmopt.internal.names(study.constraints);
        self.outputs = pkmopt.internal.names(study.outputs);
      end
    end

    function table = evaluations(self, stage)
    % EVALUATIONS  All evaluations of a stage, in their order.
    %   t = r.evaluations()        of the last stage
    %   t = r.evaluations(stage)   stage: 1, 2, ..
    % Matrices with one row per evaluation and columns as r.variables, ..: t.designs, t.objectives, t.constraints
    % (satisfied if >= 0), t.outputs. Columns: t.status (see pkmopt.Study.evaluate), t.generation (from 0), t.seconds.
      if nargin < 2
        stage = [];
      end
      [table.designs, table.objectives, table.constraints, table.outputs, table.status, table.generation, ...
       table.seconds] = pkmopt_mex('results_evaluations', self.id, stage);
    end

    function table = front(self)
    % FRONT  The Pareto front of the last stage that has one, from best to worst in the first objective.
    %   t = r.front()              fields as of EVALUATIONS; no rows if there is no front
      for stage = numel(self.stages):-1:1
        rows = pkmopt_mex('results_population', self.id, stage, []);
        if ~isempty(rows)
          break
        end
      end
      table = pkmopt.internal.selected(self.evaluations(stage), rows);
    end

    function table = population(self, generation, stage)
    % POPULATION  The evaluations of the population of a generation.
    %   t = r.population()                    of the last generation of the last stage
    %   t = r.population(generation, stage)   generation: 0, 1, .., stage: 1, 2, ..
      if nargin < 3
        stage = numel(self.stages);
      end
      if nargin < 2 || isempty(generation)
        generation = self.stages(stage).generations - 1;
      end
      rows = pkmopt_mex('results_population', self.id, stage, generation);
      table = pkmopt.internal.selected(self.evaluations(stage), rows);
    end

    function s = study(self)
    % STUDY  The study that the file contains, to evaluate further designs.
      [studyId, studyInfo] = pkmopt_mex('results_study', self.id);
      s = pkmopt.Study(studyId, studyInfo);
    end

    function page = report(self, page, overwrite)
    % REPORT  Writes the report, an HTML page with plots, and returns its name.
    %   page = r.report()                     that of the study file with .html
    %   page = r.report(page, overwrite)      overwrite: whether an existing file is replaced, default false
      if nargin < 2
        [folder, base] = fileparts(self.file);
        page = fullfile(folder, [base '.html']);
      end
      if nargin < 3
        overwrite = false;
      end
      pkmopt_mex('report', self.file, pkmopt.internal.text(page, 'page'), overwrite);
    end

    function disp(self)
      fprintf('  pkmopt.Results of %s: %s, %d evaluations\n', self.file, self.state, sum([self.stages.rows]));
    end
  end
end
