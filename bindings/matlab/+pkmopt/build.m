function build(folder)
% BUILD  Compiles the MEX file over the library libpkmopt, once after installation.
%   pkmopt.build            into the folder that contains +pkmopt
%   pkmopt.build(folder)    into a folder of your own, which is created and added to the path
% Octave needs mkoctfile (on Debian the package octave-dev), MATLAB a C compiler (not tested). The library is that of
% the source tree or the archive that contains this file, else the installed one, which pkg-config finds.
here = fileparts(fileparts(mfilename('fullpath')));
source = fullfile(here, 'pkmopt_mex.c');
if nargin < 1
  folder = here;
end
folder = pkmopt.internal.text(folder, 'folder');
if strncmp(folder, '~/', 2)
  folder = fullfile(getenv('HOME'), folder(3:end));
elseif folder(1) ~= '/'
  folder = fullfile(pwd(), folder);
end
[exists, attributes] = fileattrib(folder);
if ~exists
  [created, reason] = mkdir(folder);
  if ~created
    error('pkmopt:fileError', 'cannot create the folder %s: %s', folder, reason);
  end
elseif ~attributes.UserWrite
  error('pkmopt:fileError', 'cannot write into %s; give a folder of your own: pkmopt.build(''~/pkmopt-mex'')', folder);
end
[includeFolder, libraryFolder] = find_library(here);
wasLoaded = exist('pkmopt_mex', 'file') == 3 && mislocked('pkmopt_mex');
isOctave = exist('OCTAVE_VERSION', 'builtin') ~= 0;
output = fullfile(folder, ['pkmopt_mex.' mexext()]);
flags = {['-I' includeFolder], ['-L' libraryFolder], '-lpkmopt', source};
if isOctave
  [text, status] = mkoctfile('--mex', flags{:}, ['-Wl,-rpath,' libraryFolder], '-o', output);
  if status ~= 0
    error('pkmopt:buildFailed', 'mkoctfile has failed with status %d: %s', status, text);
  end
else
  mex(flags{:}, ['LDFLAGS=$LDFLAGS -Wl,-rpath,' libraryFolder], '-output', output);
end
if ~strcmp(folder, here)
  addpath(folder);
end
rehash();
if wasLoaded
  fprintf('this session has loaded the previous MEX file; restart to use the new one\n');
end
fprintf('compiled %s for libpkmopt %s\n', output, pkmopt.version());
if ~strcmp(folder, here)
  fprintf('later sessions need: addpath(''%s''); addpath(''%s'')\n', here, folder);
end
end

function [includeFolder, libraryFolder] = find_library(here)
% Returns the folders of pkmopt.h and libpkmopt.so.
root = fileparts(here);
places = {fullfile(root, 'include'), fullfile(root, 'lib')};  % archive
for preset = {'quickstart', 'release', 'ci'}                  % source tree
  places(end + 1, :) = {fullfile(root, 'c'), fullfile(fileparts(root), 'build', preset{1}, 'lib')}; %#ok<AGROW>
end
for i = 1:size(places, 1)
  [includeFolder, libraryFolder] = places{i, :};
  if exist(fullfile(includeFolder, 'pkmopt.h'), 'file') && exist(fullfile(libraryFolder, 'libpkmopt.so'), 'file')
    return
  end
end
[status, text] = system('pkg-config --variable=includedir pkmopt && pkg-config --variable=libdir pkmopt');
folders = strsplit(strtrim(text), sprintf('\n'));
if status ~= 0 || numel(folders) ~= 2
  error('pkmopt:fileError', ['the library libpkmopt.so was not found: build pkmopt with experiments/quickstart.sh ' ...
        'or install its package; pkg-config says: %s'], strtrim(text));
end
[includeFolder, libraryFolder] = folders{:};
end
