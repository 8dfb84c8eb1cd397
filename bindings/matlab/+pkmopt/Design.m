classdef Design < pkmopt.internal.LibraryObject
% DESIGN  A mechanism with parameters, a working mode and limits, made by m.design(...).
%
% Poses are matrices with one row per pose and one column per coordinate, joint values one column per joint. Lengths
% are in m, angles in rad. The last argument `threads` of the methods is optional: the number of threads, 0 for all
% cores. Ctrl-C ends long calls.
%
% Properties: mechanism, parameterNames, parameters (row), mode, limits (struct array with name and value).
% Methods:
%   inverse, jacobian, quantity, margins, feasible, forward, dynamics, links    at poses
%   volume, fields, surface                                                     of the workspace
%
% See also pkmopt.Mechanism.design
  properties (SetAccess = private)
    mechanism
    parameterNames
    parameters
    mode
    limits
  end

  methods
    function self = Design(mechanism, parameters, mode, limits)
      if nargin ~= 4
        error('pkmopt:invalidInput', 'a design is made by a mechanism: m = pkmopt.Mechanism(..); d = m.design(..)');
      end
      self.mechanism = mechanism;
      self.parameterNames = pkmopt.internal.names(mechanism.parameters);
      defaults = [mechanism.parameters.default];
      self.parameters = pkmopt.internal.chosen('parameter', parameters, mechanism.parameters, defaults);
      thresholds = pkmopt.internal.chosen('limit', limits, mechanism.limits, nan(1, numel(mechanism.limits)));
      isSet = ~isnan(thresholds);
      limitNames = pkmopt.internal.names(mechanism.limits);
      self.limits = struct('name', limitNames(isSet), 'value', num2cell(thresholds(isSet)));
      self.mode = mode;
      if isempty(mode)
        self.mode = mechanism.modes{1};
      end
      self.id = pkmopt_mex('design_create', mechanism.id, self.parameters, self.mode, thresholds);
    end

    function joints = inverse(self, poses, varargin)
    % INVERSE  Inverse kinematics.
    %   joints = d.inverse(poses)            one row per pose; NaN if the mechanism cannot be assembled there
    %   joints = d.inverse(poses, threads)
      joints = pkmopt_mex('design_inverse', self.id, poses, varargin{:});
    end

    function J = jacobian(self, poses, varargin)
    % JACOBIAN  Jacobians of the inverse kinematics: joint rates = J * coordinate rates.
    %   J = d.jacobian(pose)                 a matrix, joints x coordinates
    %   J = d.jacobian(poses)                poses x joints x coordinates
    %   J = d.jacobian(poses, threads)
    % Elements are NaN where the mechanism cannot be assembled, infinite or NaN at a serial singularity.
      J = pkmopt_mex('design_jacobians', self.id, poses, varargin{:});
      if size(J, 1) == 1
        J = reshape(J, size(J, 2), size(J, 3));
      end
    end

    function values = quantity(self, name, poses, varargin)
    % QUANTITY  A quantity of poses: one of m.quantities, or 'conditioning'.
    %   values = d.quantity('lti', poses)    column; NaN: undefined
    %   values = d.quantity('lti', poses, threads)
      values = pkmopt_mex('design_quantity', self.id, pkmopt.internal.text(name, 'quantity'), poses, varargin{:});
    end

    function [values, names] = margins(self, poses, varargin)
    % MARGINS  Margins of the constraints: joint ranges, limits, assembly. They are satisfied if >= 0.
    %   [values, names] = d.margins(poses)   one row per pose; names: cell row; NaN: undefined
    %   [values, names] = d.margins(poses, threads)
      [values, names] = pkmopt_mex('design_margins', self.id, poses, varargin{:});
    end

    function isFeasible = feasible(self, poses, varargin)
    % FEASIBLE  Whether the mechanism can be assembled at poses and satisfies all constraints there.
    %   isFeasible = d.feasible(poses)       logical column
    %   isFeasible = d.feasible(poses, threads)
      isFeasible = all(self.margins(poses, varargin{:}) >= 0, 2);
    end

    function poses = forward(self, joints, varargin)
    % FORWARD  Forward kinematics.
    %   poses = d.forward(joints, near)      near: one pose per row; the nearest pose found, a row of NaN if none
    %   poses = d.forward(joints)            cell column: all poses that the mechanism's method finds, for each row
    %   poses = d.forward(joints, near, threads)
    % The command `pkmopt forward` says whether the method finds all poses.
      poses = pkmopt_mex('design_forward', self.id, joints, varargin{:});
    end

    function found = dynamics(self, poses, varargin)
    % DYNAMICS  Inverse dynamics and equations of motion.
    %   s = d.dynamics(poses, velocities, accelerations, wrenches, threads)
    % All arguments but the poses may be [] or omitted, for zero rates and no wrench. Rates are those of the
    % coordinates; wrenches are forces [N] and moments [N m] on the platform, Fx Fy Fz Mx My Mz. A single row is used
    % for all poses. Results:
    %   s.forces           drive forces [N, N m], one row per pose
    %   s.inertia          joint-space inertia matrices, poses x joints x joints
    %   s.coriolis         Coriolis and centrifugal forces at the joints
    %   s.gravity          gravity at the joints
    % Results are NaN where the mechanism cannot be assembled or is singular.
      [found.forces, found.inertia, found.coriolis, found.gravity] = ...
        pkmopt_mex('design_dynamics', self.id, poses, varargin{:});
    end

    function found = links(self, poses, varargin)
    % LINKS  The links as capsules, for drawings.
    %   s = d.links(poses)                   s.names, s.parts: cell rows; s.end1, s.end2: ends of the
    %                                        axes, poses x links x 3;
    %                                        s.radius: poses x links; NaN: cannot be assembled
      [capsules, described] = pkmopt_mex('design_links', self.id, poses, varargin{:});
      count = size(capsules, 1);
      found.names = pkmopt.internal.names(described);
      found.parts = cell(1, 0);
      if ~isempty(described)
        found.parts = {described.part};
      end
      found.end1 = capsules(:, :, 1:3);
      found.end2 = capsules(:, :, 4:6);
      found.radius = reshape(capsules(:, :, 7), count, []);
    end

    function [V, gradient, relativeError, unit] = volume(self, varargin)
    % VOLUME  The volume of the workspace, with its derivatives by all parameters.
    %   V = d.volume()
    %   [V, gradient, relativeError, unit] = d.volume()   gradient: a row, in the order of d.parameterNames
    %   ... = d.volume('method', 'voxels', 'cells', struct('x', 40, 'y', 40, 'z', 40), 'threads', 2)
    % Options are the keys of [workspace] of a study, and 'threads'. The derivatives need the method 'columns', the
    % default of most mechanisms. The relative error is an estimate that
    % does not include parts of the workspace between the sampled slices; it is NaN for voxels.
      [study, threads] = self.workspaceStudy(varargin);
      values = self.workspaceParameters(study);
      if nargout > 1
        [V, gradient, relativeError] = pkmopt_mex('study_volume', study.id, values, threads);
      else
        V = pkmopt_mex('study_volume', study.id, values, threads);
      end
      unit = study.info.volume_unit;
    end

    function found = fields(self, varargin)
    % FIELDS  Quantities of poses on a grid of voxels over the workspace. Options are those of VOLUME.
    %   s = d.fields('method', 'voxels', 'cells', struct('x', 40, 'y', 40, 'z', 40))
    %   s.axes(k)    .name .unit .centres
    %   s.fixed(k)   .name .unit .value of the other coordinates
    %   s.names      names of the fields, such as 'feasible' and 'lti'; s.units, s.meanings
    %   s.values{i}  array of a field, with one dimension per axis (as of ndgrid); NaN: undefined
    %   s.volume, s.volume_unit   of the feasible cells
      [study, threads] = self.workspaceStudy(varargin);
      values = self.workspaceParameters(study);
      [info, arrays] = pkmopt_mex('study_fields', study.id, values, self.mode, threads);
      for k = 1:numel(info.axes)
        axis = info.axes(k);
        step = (axis.upper - axis.lower) / axis.cells;
        info.axes(k).centres = axis.lower + step * ((1:axis.cells) - 0.5);
      end
      found = struct('axes', info.axes, 'fixed', [], 'names', {{info.fields.name}}, 'units', {{info.fields.unit}}, ...
                     'meanings', {{info.fields.meaning}}, 'values', {arrays}, 'volume', info.volume, ...
                     'volume_unit', info.volume_unit);
      if isstruct(info.fixed)
        found.fixed = info.fixed;
      end
    end

    function [vertices, triangles] = surface(self, varargin)
    % SURFACE  The boundary surface of the workspace over three coordinates. Options are those of VOLUME.
    %   [vertices, triangles] = d.surface('method', 'voxels', 'cells', struct('x', 40, 'y', 40, 'z', 40))
    %   patch('Vertices', vertices, 'Faces', triangles, 'FaceColor', [0.6 0.7 0.9])
    % Triangles are counter-clockwise seen from outside.
      [study, threads] = self.workspaceStudy(varargin);
      [vertices, triangles] = pkmopt_mex('study_surface', study.id, self.workspaceParameters(study), threads);
    end

    function disp(self)
      values = [self.parameterNames; num2cell(self.parameters)];
      text = sprintf('%s=%.6g, ', values{:});
      fprintf('  pkmopt.Design of %s: %s\n', self.mechanism.name, text(1:end - 2));
    end
  end

  methods (Access = private)
    function [study, threads] = workspaceStudy(self, options)
      if ~strcmp(self.mode, self.mechanism.modes{1})
        error('pkmopt:invalidInput', ['the design has the working mode ''%s'', but workspaces are those of the ' ...
              'first one, ''%s'''], self.mode, self.mechanism.modes{1});
      end
      pairs = pkmopt.internal.pairs(options);
      threads = 0;
      workspace = '';
      for i = 1:2:numel(pairs)
        if strcmp(pairs{i}, 'threads')
          threads = pairs{i + 1};
        else
          workspace = sprintf('%s%s = %s\n', workspace, pkmopt.internal.toml(pairs{i}), ...
                              pkmopt.internal.toml(pairs{i + 1}));
        end
      end
      m = self.mechanism;
      key = 'type';
      mechanismText = [];
      if ~m.isBuiltIn
        key = 'file';
        mechanismText = m.text();
      end
      text = sprintf('[mechanism]\n%s = %s\n', key, pkmopt.internal.toml(m.fileName));
      if ~isempty(m.info.masses) && ~strcmp(m.info.masses, m.info.mass_models{1})
        text = sprintf('%smasses = %s\n', text, pkmopt.internal.toml(m.info.masses));
      end
      text = sprintf('%s\n[workspace]\n%s', text, workspace);
      changes = '';
      for limit = self.limits
        changes = sprintf('%slimit %s=%.17g\n', changes, limit.name, limit.value);
      end
      for i = find(~cellfun(@isempty, strfind(self.parameterNames, '.')))
        changes = sprintf('%sset %s=%.17g\n', changes, self.parameterNames{i}, self.parameters(i));
      end
      [studyId, info] = pkmopt_mex('study_from_text', text, 'workspace', mechanismText, m.fileName, changes);
      study = pkmopt.Study(studyId, info);
    end

    function values = workspaceParameters(self, study)
    % Returns the parameters in the order of the study.
      [~, order] = ismember(pkmopt.internal.names(study.info.parameters), self.parameterNames);
      values = self.parameters(order);
    end
  end
end
