% Tests of bindings/matlab with Octave: against closed forms, differences, the program's output, and misuse.
1;

function check(condition, varargin)
  if ~all(condition(:))
    error('test:failed', varargin{:});
  end
end

function check_near(a, b, tolerance, what)
  check(isequal(size(a), size(b)), '%s: sizes %s and %s', what, mat2str(size(a)), mat2str(size(b)));
  difference = max(abs(a(:) - b(:)));
  check(isempty(difference) || difference <= tolerance, '%s: the difference is %g', what, difference);
end

function check_fails(call, identifier, message)
  try
    call();
  catch failure
    check(strcmp(failure.identifier, identifier), '%s: expected the identifier %s of: %s', failure.identifier, ...
          identifier, failure.message);
    check(~isempty(strfind(failure.message, message)), 'expected "%s" in: %s', message, failure.message);
    return
  end
  error('test:failed', 'expected an error with "%s"', message);
end

function text = program(varargin)
  quoted = cellfun(@(each) [' ''' each ''''], varargin, 'UniformOutput', false);
  [status, text] = system([getenv('PKM_PROGRAM') quoted{:}]);
  check(status == 0, '%s', text);
end

function value = printed(json, name)
% The number of a name in a JSON text, with all bits, which jsondecode() does not keep.
  found = regexp(json, ['"' name '": *([-+.0-9e]+)'], 'tokens', 'once');
  check(~isempty(found), '%s is not in %s', name, json);
  value = str2double(found{1});
end

function file = experiment(name)
  file = fullfile(getenv('PKM_EXPERIMENTS'), name);
end

function test_description()
  m = pkmopt.Mechanism(experiment('mechanisms/rotary-delta.toml'));
  check(isequal(m.coordinates, {'x', 'y', 'z'}), 'coordinates');
  check(isequal(m.joints, {'arm1', 'arm2', 'arm3'}), 'joints');
  check(isequal({m.parameters.name}, {'R', 'r', 'l_a', 'l_b', 'q_min', 'q_max'}), 'parameters');
  check(strcmp(m.parameters(3).unit, 'm') && m.parameters(3).default == 0.2, 'l_a');
  check(any(strcmp({m.quantities.name}, 'lti')), 'quantities');
  check(isequal(pkmopt.Mechanism.fromText(m.text()).info, m.info), 'text');
  check(any(strcmp(pkmopt.mechanismNames(), '4ppa-2par')), 'names of mechanisms');
  models = pkmopt.Mechanism('3crr-r-cru').info.mass_models;
  check(strcmp(pkmopt.Mechanism('3crr-r-cru').withMasses(models{2}).info.masses, models{2}), 'mass model');
  check(strcmp(program('--version')(8:12), pkmopt.version()), 'version');
end

function test_kinematics()
  m = pkmopt.Mechanism('4ppa-2par');
  d = m.design();
  pose = [0.25, 0.85, -0.8, 0.5235987755982988];
  json = program('pose', '4ppa-2par', '--at', 'x=0.25,y=0.85,z=-0.8,theta=0.5235987755982988', '--json');
  q = d.inverse(pose);
  for k = 1:4
    check(q(k) == printed(json, m.joints{k}), 'the bits of joint %d', k);
  end
  check(d.quantity('conditioning', pose) == printed(json, 'conditioning'), 'the bits of a quantity');
  poses = repmat(pose, 60, 1) + 0.05 * (rand(60, 4) - 0.5);
  J = d.jacobian(poses);
  check(isequal(size(J), [60, 4, 4]), 'size of the Jacobians');
  check(isequal(d.jacobian(poses(7, :)), reshape(J(7, :, :), 4, 4)), 'the Jacobian of one pose');
  for k = 1:4
    step = zeros(1, 4);
    step(k) = 1e-6;
    difference = (d.inverse(poses + step) - d.inverse(poses - step)) / 2e-6;
    check_near(J(:, :, k), difference, 1e-6, 'Jacobian');
  end
  joints = d.inverse(poses);
  check_near(d.forward(joints, poses + 0.01), poses, 1e-9, 'forward kinematics near poses');
  found = d.forward(joints);
  check(iscell(found) && isequal(size(found), [60, 1]), 'lists of poses');
  for k = 1:60
    check(min(max(abs(found{k} - poses(k, :)), [], 2)) < 1e-9, 'forward kinematics of pose %d', k);
  end
  check(isequal(d.inverse(poses, 1), d.inverse(poses, 2)), 'threads');
  check(isequal(size(d.inverse(zeros(0, 4))), [0, 4]), 'no poses');
  other = m.design('mode', 'upper,lower');
  check(strcmp(other.mode, 'upper,lower') && ~isequal(other.inverse(pose), q), 'working mode');
end

function test_delta()
  m = pkmopt.Mechanism(experiment('mechanisms/rotary-delta.toml'));
  d = m.design('l_a', '220 mm');
  check(d.parameters(3) == 0.22, 'a text with a unit');
  rows = [0.1, 0.1, 0.04] .* (rand(50, 3) - 0.5) + [0, 0, -0.4];
  q = d.inverse(rows)(:, 1);
  elbow = [0.2 + 0.22 * cos(q), zeros(50, 1), -0.22 * sin(q)];
  check_near(sqrt(sum((elbow - rows - [0.05, 0, 0]) .^ 2, 2)), repmat(0.5, 50, 1), 1e-14, 'length of a rod');

  % At rest, drive forces and a wrench in equilibrium do no work: J' tau + W = 0, besides gravity.
  wrench = [3, -2, 5, 0, 0, 0];
  difference = d.dynamics(rows, [], [], wrench).forces - d.dynamics(rows).forces;
  J = d.jacobian(rows);
  for k = 1:50
    check_near(reshape(J(k, :, :), 3, 3)' * difference(k, :)', -wrench(1:3)', 1e-11, 'virtual work');
  end
  s = d.dynamics(rows, ones(1, 3), ones(50, 3));
  check(isequal(size(s.inertia), [50, 3, 3]), 'size of the inertia');
  rates = squeeze(sum(J .* reshape(ones(1, 3), 1, 1, 3), 3));
  forces = zeros(50, 3);
  other = d.dynamics(rows, ones(1, 3), zeros(1, 3));
  for k = 1:50  % accelerations of the joints are those of the rates J of the coordinates
    forces(k, :) = reshape(s.inertia(k, :, :), 3, 3) * rates(k, :)';
  end
  check_near(s.forces - other.forces, forces, 1e-10, 'inertia');

  poses = [0, 0, -0.4; 0, 0, -4; 0.3, 0, -0.2];
  check(isequal(d.feasible(poses), logical([1; 0; 0])), 'feasible poses');
  check(all(isnan(d.inverse(poses)(2, :))), 'a pose that does not assemble');
  [values, names] = d.margins(poses);
  check(isequal(size(values), [3, numel(names)]) && any(strcmp(names, 'arm1 reaches')), 'margins');
  s = d.links(rows);
  check_near(sqrt(sum((s.end2(:, 2, :) - s.end1(:, 2, :)) .^ 2, 3)), repmat(0.5, 50, 1), 1e-14, 'links');
  check(numel(s.names) == size(s.radius, 2) && numel(s.parts) == numel(s.names), 'names of links');

  single = m.design({'arm2.l_b', '501 mm'});
  joints = single.inverse([0, 0, -0.4]);
  check(joints(2) ~= joints(3) && strcmp(single.parameterNames{end}, 'arm2.l_b'), 'a parameter of one limb');
  check(single.volume('method', 'voxels', 'cells', struct('x', 9, 'y', 9, 'z', 9)) > 0, 'its workspace');
  a = m.design(struct('l_a', 0.25)).parameters;
  check(isequal(a, m.design({'l_a', '25 cm'}).parameters, m.design([0.2, 0.05, 0.25, 0.5, a(5:6)]).parameters), ...
        'ways to give parameters');

  many = repmat(rows, 2000, 1);
  start = tic();
  joints = d.inverse(many);
  fprintf('inverse kinematics of 10^5 poses: %.3f s\n', toc(start));
  check(isequal(joints(end - 49:end, :), d.inverse(rows)), 'many poses');
end

function test_workspace()
  d = pkmopt.Mechanism('4ppa-2par').design();
  json = program('evaluate', '4ppa-2par', '--json');
  [V, gradient, relativeError, unit] = d.volume();
  check(V == printed(json, 'volume') && relativeError == printed(json, 'relative_error'), 'the bits of the volume');
  check(strcmp(unit, 'm^2 rad') && d.volume() == V, 'volume');
  for k = 1:4
    name = d.parameterNames{k};
    above = d.mechanism.design(name, d.parameters(k) + 1e-5).volume();
    below = d.mechanism.design(name, d.parameters(k) - 1e-5).volume();
    check_near(gradient(k), (above - below) / 2e-5, 1e-5, ['gradient by ' name]);
  end
  cut = d.mechanism.design('limits', {'beta_max', '50 deg'});
  json = program('evaluate', '4ppa-2par', '--limit', 'beta_max=50deg', '--json');
  check(cut.limits.value == 50 / 180 * pi && cut.volume() < V, 'limits');
  check_near(cut.volume(), printed(json, 'volume'), 1e-15, 'volume with a limit');

  delta = pkmopt.Mechanism(experiment('mechanisms/rotary-delta.toml')).design();
  options = {'method', 'voxels', 'cells', struct('x', 30, 'y', 31, 'z', 32)};
  V = delta.volume();
  voxels = delta.volume(options{:});
  check(abs(voxels - V) < 0.02 * V && voxels == delta.volume(options{:}, 'threads', 1), 'voxels');
  s = delta.fields(options{:});
  lti = s.values{strcmp(s.names, 'lti')};
  check(isequal(size(lti), [30, 31, 32]) && numel(s.axes(2).centres) == 31, 'size of the fields');
  at = find(isfinite(lti));
  check(numel(at) == sum(s.values{strcmp(s.names, 'feasible')}(:)) && s.volume == voxels, 'feasible cells');
  [i, j, k] = ind2sub(size(lti), at);
  poses = [s.axes(1).centres(i)', s.axes(2).centres(j)', s.axes(3).centres(k)'];
  check_near(delta.quantity('lti', poses), lti(at), 1e-12, 'fields');
  [vertices, triangles] = delta.surface(options{:});
  a = vertices(triangles(:, 1), :);
  b = vertices(triangles(:, 2), :);
  c = vertices(triangles(:, 3), :);
  check(abs(sum(dot(a, cross(b, c, 2), 2)) / 6 - V) < 0.02 * V, 'surface');
end

function test_study()
  s = pkmopt.Study(experiment('4ppa-2par/paper-problem.toml'));
  check(isequal(s.variables, {'a', 'b', 'l_u', 'l_d'}), 'variables');
  check(isequal(s.maximise, true) && isequal(s.baseline, [0.2, 0.8, 0.6, 0.55]), 'description');
  X = s.lower + rand(40, 4) .* (s.upper - s.lower);
  [F, G, status, outputs] = s.evaluate(X);
  check(isequal(size(F), [40, numel(s.objectives)]) && isequal(size(G), [40, numel(s.constraints)]) && ...
        isequal(size(outputs), [40, numel(s.outputs)]), 'sizes');
  check(isequal(status == 0, all(G >= 0, 2)) && isa(status, 'uint8'), 'status');
  check(isequal(s.evaluate(X(3, :)), F(3, :)), 'one design');
  json = program('evaluate', experiment('4ppa-2par/paper-problem.toml'), '--json', '--set', ...
                 sprintf('a=%.17g,b=%.17g,l_u=%.17g,l_d=%.17g', X(3, :)));
  check(F(3) == printed(json, s.objectives{1}), 'the bits of an objective');

  % Forty designs of an expression with a known derivative.
  text = sprintf(['[mechanism]\ntype = "4ppa-2par"\n[variables]\na = { min = "200 mm", max = 0.5 }\n' ...
                  'b = { min = 0.5, max = 1.2 }\n[[objective]]\ntype = "workspace-volume"\n[[constraint]]\ntype = "expression"\n' ...
                  'name = "root"\nexpression = "sqrt(0.45 - a) - 0.1*b"\nunit = "m"\n[[stage]]\n']);
  s = pkmopt.Study.fromText([text sprintf('optimiser = "ga"\npopulation = 20\ngenerations = 8\n')]);
  X = s.lower + rand(40, 2) .* (s.upper - s.lower);
  X(:, 1) = 0.8 * X(:, 1);
  [F, G, dF, dG] = s.differentiate(X);
  check_near(G, sqrt(0.45 - X(:, 1)) - 0.1 * X(:, 2), 1e-15, 'margins');
  check_near(reshape(dG, 40, 2), [-0.5 ./ sqrt(0.45 - X(:, 1)), repmat(-0.1, 40, 1)], 1e-13, 'derivatives');
  for k = 1:2
    step = zeros(1, 2);
    step(k) = 1e-6;
    check_near(dF(:, 1, k), (s.evaluate(X + step) - s.evaluate(X - step)) / 2e-6, 1e-5, 'derivatives of the volume');
  end
  [F, ~, dF] = s.differentiate(X(5, :));
  check(isequal(size(dF), [1, 2]) && F == s.evaluate(X(5, :)), 'derivatives of one design');
  [~, ~, status] = s.evaluate([0.3, 0.8; 0.47, 0.8]);
  check(isequal(status, uint8([0; 3])), 'a failed design');
  check(~isempty(strfind(s.whyFailed([0.47, 0.8]), 'root')) && isempty(s.whyFailed([0.3, 0.8])), 'why it failed');

  % Runs: the bits of the program.
  folder = tempname();
  mkdir(folder);
  remove = onCleanup(@() confirm_and_remove(folder));
  file = @(name) fullfile(folder, name);
  r = s.run(file('mine.h5'), 'seed', 3);
  write(file('study.toml'), s.text());
  program('run', file('study.toml'), '--output', file('theirs.h5'), '--seed', '3', '--quiet');
  mine = rmfield(r.evaluations(), 'seconds');
  theirs = rmfield(pkmopt.Results(file('theirs.h5')).evaluations(), 'seconds');
  check(isequaln(mine, theirs), 'evaluations of a run');
  check(size(mine.designs, 1) == r.stages.rows, 'rows of a run');
  check(strcmp(r.state, 'finished') && isempty(r.outcome.stopped), 'the end of a run');
  row = r.stages.best_row;
  check(isequal([r.best.design.a, r.best.design.b], mine.designs(row, :)), 'the best design');
  check(r.best.objectives.workspace_volume == max(mine.objectives(mine.status == 0)), 'the best volume');
  check(isequaln(r.study().evaluate(mine.designs(1:5, :)), mine.objectives(1:5)), 'the study of a file');
  last = r.population();
  check(isequal(last.designs, r.population(r.stages.generations - 1, 1).designs) && size(last.designs, 1) == 20, ...
        'the last population');
  check(all(r.population(0).generation == 0), 'the first population');
  r = pkmopt.resume(file('mine.h5'), 'generations', 10);
  check(r.stages.generations == 11 && r.stages.rows > numel(mine.status), 'resume');
  check_fails(@() s.run(file('mine.h5')), 'pkmopt:fileError', 'exists');
  check(~exist(file('mine.html'), 'file'), 'no report yet');

  % A Pareto front.
  size_of_robot = sprintf(['[[objective]]\ntype = "expression"\nname = "size"\nexpression = "a + b"\nunit = "m"\n' ...
                           'direction = "minimise"\n[[constraint]]']);
  text = [strrep(text, '[[constraint]]', size_of_robot) ...
          sprintf('optimiser = "nsga2"\npopulation = 20\ngenerations = 8\n')];
  r = pkmopt.Study.fromText(text).run(file('front.h5'));
  front = r.front();
  check(issorted(front.objectives(:, 1), 'descend') && issorted(front.objectives(:, 2), 'descend'), 'front');
  check(size(front.designs, 1) > 3 && all(front.status == 0), 'designs of the front');
end

function write(name, text)
  stream = fopen(name, 'w');
  fputs(stream, text);
  fclose(stream);
end

function confirm_and_remove(folder)
  confirm_recursive_rmdir(false, 'local');
  rmdir(folder, 's');
end

function test_mistakes()
  m = pkmopt.Mechanism(experiment('mechanisms/rotary-delta.toml'));
  d = m.design();
  s = pkmopt.Study(experiment('4ppa-2par/paper-problem.toml'));
  before = pkmopt_mex('object_count');
  invalid = 'pkmopt:invalidInput';
  check_fails(@() pkmopt.Mechanism('4ppa'), invalid, 'did you mean ''4ppa-2par''?');
  check_fails(@() pkmopt.Mechanism('nowhere.toml'), invalid, 'nowhere.toml');
  check_fails(@() pkmopt.Mechanism(3), invalid, 'name is of class double; expected a text');
  check_fails(@() pkmopt.Mechanism.fromText('[mechanism'), invalid, 'mechanism.toml:1');
  check_fails(@() m.design('l_c', 1), invalid, 'unknown parameter ''l_c''; expected one of R, r, l_a, l_b');
  check_fails(@() m.design('l_c', 1), invalid, 'did you mean ''l_a''?');
  check_fails(@() m.design('l_a', '3 kg'), invalid, '''l_a'': found ''3 kg''');
  check_fails(@() m.design('l_a', [1, 2]), invalid, 'expected a number');
  check_fails(@() m.design('l_a', -1), 'pkmopt:designError', 'outside');
  check_fails(@() m.design([1, 2]), invalid, 'there are 2 values');
  check_fails(@() m.design('limits', {'lti', 1}), invalid, 'unknown limit ''lti''');
  check_fails(@() m.design('mode', 'sideways'), invalid, 'sideways');
  check_fails(@() m.withMasses('none'), invalid, 'mass');
  check_fails(@() d.inverse([1, 2]), invalid, 'poses is 1 x 2; expected 3 columns: x, y, z');
  check_fails(@() d.inverse(single([0, 0, -0.4])), invalid, 'poses is single');
  check_fails(@() d.inverse([0, 0, 1i]), invalid, 'complex');
  check_fails(@() d.inverse([]), invalid, 'poses is [] or missing');
  check_fails(@() d.inverse([0, 0, -0.4], -1), invalid, 'threads is -1');
  check_fails(@() d.inverse([0, 0, -0.4], 'two'), invalid, 'threads');
  check_fails(@() d.quantity('ltj', [0, 0, -0.4]), invalid, 'did you mean ''lti''?');
  check_fails(@() d.forward(zeros(2, 3), zeros(1, 3)), invalid, 'near has 1 rows');
  check_fails(@() d.dynamics(zeros(3, 3), zeros(2, 3)), invalid, 'velocities has 2 rows');
  check_fails(@() d.volume('metod', 'voxels'), invalid, 'did you mean ''method''?');
  check_fails(@() d.volume('tolerance'), invalid, 'names and values');
  check_fails(@() pkmopt.Study(experiment('4ppa-2par/paper-problem.toml'), {'set aa=1'}), invalid, ...
              'did you mean ''a''?');
  check_fails(@() pkmopt.Study.fromText('[studi]'), invalid, 'did you mean ''study''?');
  check_fails(@() s.evaluate(zeros(1, 3)), invalid, 'designs is 1 x 3; expected 4 columns: a, b, l_u, l_d');
  check_fails(@() s.run('x.h5', 'sed', 1), invalid, 'did you mean ''seed''?');
  check_fails(@() s.run('x.h5', 'seed', 1.5), invalid, 'seed is 1.5');
  check_fails(@() s.run('/nowhere/x.h5'), 'pkmopt:fileError', '/nowhere/x.h5');
  check_fails(@() pkmopt.Results('nowhere.h5'), 'pkmopt:fileError', 'nowhere.h5');
  check_fails(@() pkmopt_mex('design_inverze'), invalid, 'unknown command');
  check_fails(@() pkmopt_mex('design_inverse', m.id, [0, 0, 0]), invalid, 'this design has been deleted');
  check_fails(@() pkmopt_mex('design_inverse', uint64(7), [0, 0, 0]), invalid, 'this design has been deleted');
  check(pkmopt_mex('object_count') == before, 'errors have left objects');
  check_fails(@() pkmopt.Mechanism('4ppa-2par').design('mode', 'upper,lower').volume(), invalid, 'working mode');
end

function test_objects()
  before = pkmopt_mex('object_count');
  m = pkmopt.Mechanism('4ppa-2par');
  d = m.design();
  check(pkmopt_mex('object_count') == before + 2, 'objects');
  clear m  % the design keeps its mechanism
  check(d.mechanism.design().inverse([0.25, 0.85, -0.8, 0]) == d.inverse([0.25, 0.85, -0.8, 0]), 'the mechanism of d');
  id = d.id;
  pkmopt_mex('free', id);
  pkmopt_mex('free', id);
  check_fails(@() d.inverse([0.25, 0.85, -0.8, 0]), 'pkmopt:invalidInput', 'this design has been deleted');
  other = pkmopt.Mechanism('4ppa-2par').design();
  check(other.id ~= id, 'an identifier was used twice');
  clear d  % does not free what has its place
  check(isfinite(other.inverse([0.25, 0.85, -0.8, 0])), 'the other design');
  clear other
  check(pkmopt_mex('object_count') == before, 'objects are left');
  check(mislocked('pkmopt_mex'), 'the MEX file could be unloaded');
end

function test_interrupt()
% Ctrl-C ends a call that would take some seconds, without a crash.
  code = ['s = pkmopt.Study(''' experiment('4ppa-2par/wide-bounds-voxels.toml') '''); x = repmat(s.upper, 2e6, 1); ' ...
          'system(sprintf(''(sleep 0.2; kill -INT %d) &'', getpid())); ' ...
          'try, s.evaluate(x, true, 1); catch e, disp(e.identifier), end'];
  [status, text] = system(['octave-cli --no-init-file --quiet --eval "' code '" 2>&1']);
  check(~isempty(strfind(text, 'pkmopt:stopped')), 'status %d, output %s', status, text);
end

rand('seed', 1);
pkmopt.mechanismNames();
for name = {'description', 'kinematics', 'delta', 'workspace', 'study', 'mistakes', 'objects', 'interrupt'}
  start = tic();
  feval(['test_' name{1}]);
  fprintf('%-12s %6.2f s\n', name{1}, toc(start));
end
alive_at_the_end = pkmopt.Mechanism('4ppa-2par').design();
disp('all tests have passed');
