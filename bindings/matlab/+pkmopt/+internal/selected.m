function table = selected(table, rows)
% The given rows of all fields.
for name = fieldnames(table)'
  table.(name{1}) = table.(name{1})(rows, :);
end
end
