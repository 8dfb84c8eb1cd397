function text = toml(value)
% Writes a value of MATLAB as a TOML value in one line.
if isa(value, 'string') && isscalar(value)
  value = char(value);
end
if ischar(value)
  text = ['"' strrep(strrep(value, '\', '\\'), '"', '\"') '"'];
elseif isstruct(value) && isscalar(value)
  fields = fieldnames(value)';
  entries = cellfun(@(name) [name ' = ' pkmopt.internal.toml(value.(name))], fields, 'UniformOutput', false);
  text = ['{ ' strjoin(entries, ', ') ' }'];
elseif iscell(value)
  entries = cellfun(@pkmopt.internal.toml, value(:)', 'UniformOutput', false);
  text = ['[' strjoin(entries, ', ') ']'];
elseif (isnumeric(value) || islogical(value)) && ~isscalar(value)
  text = pkmopt.internal.toml(num2cell(value));
elseif islogical(value)
  words = {'false', 'true'};
  text = words{value + 1};
elseif isnumeric(value) && isreal(value)
  text = lower(sprintf('%.17g', value));
else
  error('pkmopt:invalidInput', 'found a value of class %s; expected a number, a text, a cell or a struct', ...
        class(value));
end
end
