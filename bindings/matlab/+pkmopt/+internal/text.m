function value = text(value, what)
% A text as a char row; accepts the class string of MATLAB.
if isa(value, 'string') && isscalar(value)
  value = char(value);
end
if ~ischar(value) || size(value, 1) > 1
  error('pkmopt:invalidInput', '%s is of class %s; expected a text', what, class(value));
end
end
