classdef LibraryObject < handle
% LIBRARYOBJECT  An object that the library keeps, freed with its last copy in MATLAB.
  properties (SetAccess = protected, Hidden, Transient)
    id  % empty: none
  end

  methods
    function delete(self)
      if ~isempty(self.id)
        pkmopt_mex('free', self.id);
      end
    end
  end
end
