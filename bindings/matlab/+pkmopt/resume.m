function results = resume(file, varargin)
% RESUME  Continues a stopped study from its file, or extends the last stage of a finished one.
%   results = pkmopt.resume('study.h5')
%   results = pkmopt.resume('study.h5', 'generations', 200, 'evaluations', [], 'timeLimit', 60, 'threads', 4)
% generations, evaluations: new total numbers of the last stage; 0 or [] keeps the old limit. timeLimit: wall time in s.
% Ctrl-C stops the run with a checkpoint.
%
% See also pkmopt.Study.run, pkmopt.Results
pkmopt.internal.require_mex();
known = struct('generations', 0, 'evaluations', 0, 'timeLimit', 0, 'threads', 0);
options = pkmopt.internal.options(known, varargin);
file = pkmopt.internal.text(file, 'file');
outcome = pkmopt_mex('study_resume', file, options.generations, options.evaluations, options.timeLimit, ...
                     options.threads);
results = pkmopt.Results(file, outcome);
end
