function values = options(values, given)
% Replaces the values of a struct by those given as names and values.
list = pkmopt.internal.pairs(given);
for i = 1:2:numel(list)
  if ~isfield(values, list{i})
    pkmopt.internal.refuse('option', list{i}, fieldnames(values)');
  end
  values.(list{i}) = list{i + 1};
end
end
