function names = mechanismNames()
% MECHANISMNAMES  Names of the built-in mechanisms.
%   names = pkmopt.mechanismNames()   cell row of texts
pkmopt.internal.require_mex();
names = pkmopt_mex('mechanism_names');
end
