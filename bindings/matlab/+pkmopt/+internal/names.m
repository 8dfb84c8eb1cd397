function list = names(entries)
% The names of a struct array, a cell row.
list = cell(1, 0);
if ~isempty(entries)
  list = {entries.name};
end
end
