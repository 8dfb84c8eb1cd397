% Inverse kinematics by loadlibrary() of MATLAB, without a MEX file. This is a prototype that has not been tested,
% because MATLAB is not available to the tests, and Octave has no loadlibrary(). Run it in this folder with the name of
% the library, for example library = '/usr/lib/x86_64-linux-gnu/libpkmopt.so.0'.
loadlibrary(library, 'pkmopt_prototypes.h', 'alias', 'pkmopt');
mechanism = libpointer('voidPtrPtr');
design = libpointer('voidPtrPtr');
if calllib('pkmopt', 'pkmopt_mechanism_by_name', '4ppa-2par', mechanism) ~= 0 || ...
   calllib('pkmopt', 'pkmopt_design_create', mechanism.Value, [], 'lower,lower', [], design) ~= 0
  error('pkmopt:invalidInput', '%s', calllib('pkmopt', 'pkmopt_error'));
end
poses = [0.25 0.85 -0.8 pi/6; 0.25 0.90 -0.8 pi/6]';  % the library stores row by row: a column per pose
joints = libpointer('doublePtr', zeros(4, size(poses, 2)));
if calllib('pkmopt', 'pkmopt_design_inverse', design.Value, size(poses, 2), poses, joints, []) ~= 0
  error('pkmopt:invalidInput', '%s', calllib('pkmopt', 'pkmopt_error'));
end
disp(joints.Value')
calllib('pkmopt', 'pkmopt_design_free', design.Value);
calllib('pkmopt', 'pkmopt_mechanism_free', mechanism.Value);
unloadlibrary('pkmopt');
