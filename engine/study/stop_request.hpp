// Ctrl-C and SIGTERM ask a running study to stop after the generation at hand.
#pragma once

namespace pkm {

/// While it lives, SIGINT and SIGTERM set a flag instead of ending the process; a second one ends it at once. SIGXFSZ
/// is ignored, so that a file-size limit is an error that can be told. The previous handlers come back afterwards.
class StopRequest {
 public:
  StopRequest();
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

  /// The signal received, or 0.
  static int signal();
};

}  // namespace pkm
