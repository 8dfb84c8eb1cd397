function list = names(entries)
% Returns the field .name of all elements of a struct array as a cell row.
list = cell(1, 0);
if ~isempty(entries)
  list = {entries.name};
end
end
