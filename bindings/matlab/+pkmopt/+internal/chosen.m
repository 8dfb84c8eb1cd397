function values = chosen(what, given, known, values)
% Replaces default values by those given by name: numbers in SI units, or texts such as '30 mm'.
list = pkmopt.internal.pairs(given);
names = pkmopt.internal.names(known);
for i = 1:2:numel(list)
  at = find(strcmp(list{i}, names));
  if isempty(at)
    pkmopt.internal.refuse(what, list{i}, names);
  end
  value = list{i + 1};
  if ischar(value) || isa(value, 'string')
    try
      value = pkmopt_mex('number', char(value), known(at).unit);
    catch
      error('pkmopt:invalidInput', '%s ''%s'': found ''%s''; expected a number, alone or with a unit like %s', ...
            what, list{i}, char(value), known(at).unit);
    end
  end
  if ~isnumeric(value) || ~isscalar(value) || ~isreal(value)
    error('pkmopt:invalidInput', '%s ''%s'' is of class %s and size %s; expected a number, or a text with a unit', ...
          what, list{i}, class(value), mat2str(size(value)));
  end
  values(at) = value;
end
end
