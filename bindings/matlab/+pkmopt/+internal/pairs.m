function list = pairs(given)
% Converts a struct, or a cell {name, value, ..}, to a cell row {name, value, ..}.
if isstruct(given) && isscalar(given)
  list = [fieldnames(given)'; struct2cell(given)'];
  list = list(:)';
elseif isempty(given)
  list = {};
elseif iscell(given) && mod(numel(given), 2) == 0
  list = given(:)';
  for i = 1:2:numel(list)
    list{i} = pkmopt.internal.text(list{i}, 'name');
  end
else
  error('pkmopt:invalidInput', 'found a value of class %s; expected a struct, or names and values', class(given));
end
end
