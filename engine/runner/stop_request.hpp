// Signal handling of a running study: Ctrl-C (SIGINT), SIGTERM and a closed terminal (SIGHUP) request a stop with a
// checkpoint instead of ending the process.
#pragma once

namespace pkm {

/// RAII guard. During its lifetime SIGINT, SIGTERM and SIGHUP set a flag instead of ending the process; a signal that
/// the process already ignores (nohup) stays ignored. A further signal ends the process at once, but only if it arrives
/// more than a second after the first, because `timeout` and shells send signals twice. SIGXFSZ and SIGPIPE are
/// ignored, so that exceeding a file size limit or writing to a closed pipe is reported as an error. Guards may be
/// nested: the outermost one clears the flag when it is constructed and restores the previous handlers when it is
/// destroyed.
class StopRequest {
 public:
  StopRequest();
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

  /// @return number of the first signal received; 0: none
  static int signal();
  /// @return name of a signal: "SIGINT", "SIGTERM" or "SIGHUP"
  static const char* name(int signal);
};

}  // namespace pkm
