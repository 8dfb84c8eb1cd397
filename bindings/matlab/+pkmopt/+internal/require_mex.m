function require_mex()
% Throws an error if the MEX file has not been compiled, or its folder is not on the path.
if exist('pkmopt_mex', 'file') ~= 3
  error('pkmopt:notBuilt', ['the MEX file pkmopt_mex is missing: run pkmopt.build once; if it is in a folder of ' ...
        'its own, add that folder to the path']);
end
end
