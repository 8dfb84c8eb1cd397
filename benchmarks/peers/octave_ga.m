% GNU Octave's ga with default settings (stochastic uniform selection, scattered crossover 0.8, Gaussian mutation that
% shrinks over the generations, 2 elites). It supports neither bounds nor constraints, so candidates are projected onto
% the bounds and penalised by an l1 penalty, as for pagmo. octave_ga.m PROBLEM.json ACTION..., with the actions of
% peer.py.
1;

% Values of the three constraints, satisfied if >= 0 (eq 21, eq 18, a <= b) [m]; empty if the problem has none.
function values = margins(p, design)
  values = [];
  if p.constrained
    a = design(1); b = design(2); l_u = design(3); l_d = design(4);
    values = [l_d - hypot(l_u, b - a * p.cos_theta_min) / 2, p.L0 - 2 * l_u * cos(p.alpha_min), b - a];
  end
end

% Fitness of a population, minimised by ga; one row per design. `trials` counts candidates and records the best ratio.
function scores = fitness(p, population)
  global trials
  designs = min(max(population, p.lower'), p.upper');
  scores = zeros(rows(designs), 1);
  for i = 1:rows(designs)
    violation = -sum(min(margins(p, designs(i, :)), 0));
    ratio = feasible_cells(p, designs(i, :)) / prod(p.cells);  % the volume of the box equals V_mech = pi b (l_u + l_d)
    scores(i) = -ratio + 10 * violation;
    if trials.reached, continue, end
    trials.tried++;
    if violation == 0, trials.best = max(trials.best, ratio); end
    trials.reached = trials.best >= p.target;
  end
end

function found = run(p, seed, generations, target)
  global trials
  trials = struct("reached", false, "tried", 0, "best", 0);
  rand("twister", seed); randn("twister", seed);
  p.target = target;
  options = gaoptimset("PopInitRange", [p.lower'; p.upper'], "PopulationSize", 20, "Generations", generations, ...
                       "FitnessLimit", -target, "Vectorized", "on");
  ga(@(population) fitness(p, population), 4, [], [], [], [], [], [], [], options);
  found = trials;
end

pkg load ga
addpath(fileparts(mfilename("fullpath")));
given = argv();
p = jsondecode(fileread(given{1}));
switch given{2}
  case "counts"
    designs = jsondecode(fileread(given{3}));
    result = arrayfun(@(i) feasible_cells(p, designs(i, :)), 1:rows(designs));
  case "generations"
    begin = tic();
    found = run(p, str2double(given{4}), str2double(given{3}), Inf);
    result = struct("candidates", found.tried, "seconds", toc(begin));
  case "search"
    start = cputime();
    for seed = 1:str2double(given{3})
      begin = cputime();
      found = run(p, seed, str2double(given{4}) / 20 - 1, p.target);
      found.cpu = start + cputime() - begin;
      result(seed) = found;
    end
end
puts([jsonencode(result) "\n"]);
