classdef LibraryObject < handle
% LIBRARYOBJECT  Handle of an object of the C library, which is freed when the last copy of the handle is deleted.
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
