function values = options(values, given)
% Replaces values of a struct of default options by those that the caller gave as pairs of name and value.
list = pkmopt.internal.pairs(given);
for i = 1:2:numel(list)
  if ~isfield(values, list{i})
    pkmopt.internal.refuse('option', list{i}, fieldnames(values)');
  end
  values.(list{i}) = list{i + 1};
end
end
