function refuse(what, name, known)
% Throws the error for an unknown name, whose message suggests the most similar known name.
suggestion = '';
distances = cellfun(@(other) edit_distance(lower(name), lower(other)), known);
[smallest, at] = min(distances);
if ~isempty(at) && smallest <= max(1, floor(numel(name) / 3))
  suggestion = sprintf('; did you mean ''%s''?', known{at});
end
error('pkmopt:invalidInput', 'unknown %s ''%s''; expected one of %s%s', what, name, strjoin(known, ', '), suggestion);
end

function distance = edit_distance(a, b)
% Returns the Levenshtein distance of two texts: the least number of inserted, deleted and replaced characters.
row = 0:numel(b);
for i = 1:numel(a)
  previous = row;
  row(1) = i;
  for j = 1:numel(b)
    row(j + 1) = min([previous(j + 1) + 1, row(j) + 1, previous(j) + (a(i) ~= b(j))]);
  end
end
distance = row(end);
end
