function text = version()
% VERSION  Version of the library as text, such as '0.2.0'.
pkmopt.internal.require_mex();
text = pkmopt_mex('version');
end
