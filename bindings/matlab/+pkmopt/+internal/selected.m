function table = selected(table, rows)
% Selects the given rows of the matrices in all fields of a struct.
for name = fieldnames(table)'
  table.(name{1}) = table.(name{1})(rows, :);
end
end
