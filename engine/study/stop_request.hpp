// Ctrl-C, SIGTERM and a closed terminal ask a running study to stop after the generation at hand.
#pragma once

namespace pkm {

/// While one lives, SIGINT, SIGTERM and SIGHUP set a flag instead of ending the process; one that the process was told
/// to ignore (nohup) stays ignored. A further signal ends it at
/// once, but only a second after the first: `timeout` and shells send theirs twice. SIGXFSZ and SIGPIPE are ignored, so
/// that a file-size limit or a closed pipe is an error that can be told. May be nested: the flag is cleared and the
/// previous handlers come back with the outermost one.
class StopRequest {
 public:
  StopRequest();
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

  /// The signal received, or 0.
  static int signal();
  /// "SIGINT", ...
  static const char* name(int signal);
};

}  // namespace pkm
