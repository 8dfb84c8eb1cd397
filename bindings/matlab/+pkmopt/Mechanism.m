classdef Mechanism < pkmopt.internal.LibraryObject
% MECHANISM  A mechanism: built in, or from a mechanism file.
%   m = pkmopt.Mechanism('4ppa-2par')          built in; see pkmopt.mechanismNames
%   m = pkmopt.Mechanism('rotary-delta.toml')  from a file, whose name ends with .toml
%   m = pkmopt.Mechanism.fromText(toml)        from the text of a file
%
% Properties:
%   name, coordinates, joints, modes          texts, and cell rows of texts
%   parameters(i)  .name .unit .default .min .max .meaning
%   quantities(i)  .name .unit .meaning .depends_on
%   limits(i)      .name .unit .min .max .meaning
%   info           everything that `pkmopt list NAME --json` prints
% Methods: design, withMasses, text. Lengths are in m, angles in rad, all other numbers in SI units.
%
% See also pkmopt.Mechanism.design, pkmopt.Design, pkmopt.Study
  properties (SetAccess = private)
    info
    name
    coordinates
    joints
    modes
    parameters
    quantities
    limits
  end
  properties (SetAccess = private, Hidden, Transient)
    isBuiltIn
    fileName
  end

  methods
    function self = Mechanism(name, id, info)
      if nargin == 3  % of an object of the library
        self.fill(id, info, name);
        return
      end
      if nargin ~= 1
        error('pkmopt:invalidInput', 'expected the name of a built-in mechanism, or of a mechanism file *.toml');
      end
      pkmopt.internal.require_mex();
      name = pkmopt.internal.text(name, 'name');
      self.fileName = name;
      self.isBuiltIn = isempty(regexp(name, '\.toml$', 'once'));
      if self.isBuiltIn
        command = 'mechanism_by_name';
      else
        command = 'mechanism_from_file';
      end
      [id, info] = pkmopt_mex(command, name);
      self.fill(id, info, {self.isBuiltIn, name});
    end

    function d = design(self, varargin)
    % DESIGN  A design: the default parameters except those that are given.
    %   d = m.design()
    %   d = m.design('l_a', '220 mm', 'l_b', 0.48)               numbers in SI units, or texts with a unit
    %   d = m.design('a', 0.3, 'mode', 'upper,lower', 'limits', {'beta_max', '50 deg'})
    %   d = m.design(values, ...)   values: a row vector of all parameters, or a struct, or a cell {name, value, ..}
    % 'mode' is the working mode, 'limits' are thresholds of poses by name, a struct or a cell {name, value, ..}. A
    % parameter of a single limb is named as 'arm2.l_b'.
      values = {};
      if mod(numel(varargin), 2) == 1
        values = varargin{1};
        varargin(1) = [];
      end
      mode = '';
      limits = {};
      pairs = {};
      for i = 1:2:numel(varargin)
        switch pkmopt.internal.text(varargin{i}, 'name of a parameter')
          case 'mode'
            mode = pkmopt.internal.text(varargin{i + 1}, 'mode');
          case 'limits'
            limits = varargin{i + 1};
          otherwise
            pairs = [pairs, varargin(i:i + 1)]; %#ok<AGROW>
        end
      end
      mechanism = self;
      if isnumeric(values)
        if numel(values) ~= numel(self.parameters)
          error('pkmopt:invalidInput', 'there are %d values of parameters; expected %d: %s', numel(values), ...
                numel(self.parameters), strjoin(pkmopt.internal.names(self.parameters), ', '));
        end
        given = [pkmopt.internal.names(self.parameters); num2cell(double(values(:)'))];
        pairs = [given(:)', pairs];
      else
        pairs = [pkmopt.internal.pairs(values), pairs];
        own = setdiff(pairs(1:2:end), pkmopt.internal.names(self.parameters));
        own = own(~cellfun(@isempty, strfind(own, '.')));
        if ~isempty(own)
          [newId, newInfo] = pkmopt_mex('mechanism_from_text', self.text(), self.fileName, strjoin(own, ','));
          mechanism = pkmopt.Mechanism({self.isBuiltIn, self.fileName}, newId, newInfo);
          if ~isequal(self.info.masses, newInfo.masses)
            mechanism = mechanism.withMasses(self.info.masses);
          end
        end
      end
      d = pkmopt.Design(mechanism, pairs, mode, limits);
    end

    function m = withMasses(self, model)
    % WITHMASSES  A copy of the mechanism with another mass model, one of info.mass_models.
    %   m = m.withMasses('point-masses')
      [newId, newInfo] = pkmopt_mex('mechanism_with_masses', self.id, pkmopt.internal.text(model, 'mass model'));
      m = pkmopt.Mechanism({self.isBuiltIn, self.fileName}, newId, newInfo);
    end

    function toml = text(self)
    % TEXT  The text of the mechanism file.
      toml = pkmopt_mex('mechanism_text', self.id);
    end

    function disp(self)
      fprintf('  pkmopt.Mechanism %s: %s -> %s\n', self.name, strjoin(self.joints, ', '), ...
              strjoin(self.coordinates, ', '));
    end
  end

  methods (Access = private)
    function fill(self, id, info, origin)
      self.id = id;
      self.isBuiltIn = origin{1};
      self.fileName = origin{2};
      self.info = info;
      self.name = info.name;
      self.coordinates = info.coordinates;
      self.joints = info.joints;
      self.modes = info.modes;
      self.parameters = info.parameters;
      self.quantities = info.quantities;
      self.limits = info.limits;
    end
  end

  methods (Static)
    function m = fromText(toml, fileName)
    % FROMTEXT  A mechanism from the text of a mechanism file.
    %   m = pkmopt.Mechanism.fromText(toml)
    %   m = pkmopt.Mechanism.fromText(toml, fileName)   fileName is named in messages
      if nargin < 2
        fileName = 'mechanism.toml';
      end
      pkmopt.internal.require_mex();
      [id, info] = pkmopt_mex('mechanism_from_text', pkmopt.internal.text(toml, 'toml'), fileName);
      m = pkmopt.Mechanism({false, fileName}, id, info);
    end
  end
end
