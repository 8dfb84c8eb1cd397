function value = text(value, what)
% Converts a text to a char row; also accepts MATLAB's class string.
if isa(value, 'string') && isscalar(value)
  value = char(value);
end
if ~ischar(value) || size(value, 1) > 1
  error('pkmopt:invalidInput', '%s is of class %s; expected a text', what, class(value));
end
end
