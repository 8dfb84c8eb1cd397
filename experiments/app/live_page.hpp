// The page of a running study: one HTML file without scripts, which a browser reloads every few seconds. It shows the
// progress, the best design with its active constraints, and the best values over the generations.
#pragma once

#include <functional>
#include <string>

#include "engine/runner/progress.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// Data from which the text of the page is generated.
struct LivePageState {
  std::string study_file;  ///< name of the study file
  std::string updated;     ///< time of this state, ISO 8601 in UTC
  ProgressReport progress;
  /// StudyState::running: the page reloads itself; otherwise it does not change any more.
  StudyState state = StudyState::running;
  std::string stopped;  ///< reason why the run was interrupted, such as "SIGINT"; "" otherwise
  std::string report;   ///< name of the report's file, to which a finished page links; "": there is none
  std::string failure;  ///< error that ended the run; "": none
};
std::string live_page_text(const StudyContents& contents, const LivePageState& state);

/// Writes the page of one run. Writing is limited to 0.5 % of the time of the run, and to once in two seconds.
class LivePage {
 public:
  /// Writes the first page, before any evaluation. Throws StorageError if that fails; later failures are ignored, so
  /// that they do not end a long run, and the page keeps its last state.
  /// @param path      path of the page
  /// @param contents  the study as far as it is known: its name suffices
  /// @param now       clock [s]; default: steady_seconds()
  LivePage(std::string path, const std::string& study_file, const StudyContents& contents,
           std::function<double()> now = {});
  /// Writes the page if enough time has passed since it was last written.
  void update(const StudyContents& contents, const ProgressReport& progress);
  /// Writes the final state. @param report  path of the report in the folder of the page; "": none
  void finish(const StudyContents& contents, const std::string& stopped, const std::string& report);
  /// Writes the final state of a run that has ended with an error. A failure to write it is ignored, because the error
  /// itself is reported.
  /// @param contents  the study at its last checkpoint
  void fail(const StudyContents& contents, const std::string& error);

 private:
  void write(const StudyContents& contents);

  std::string path_;
  std::function<double()> now_;
  LivePageState state_;
  double next_ = 0;  ///< earliest time of the next write [s]
};

/// Path of the page of a study: study.live.html for study.h5.
std::string live_page_file(const std::string& study_file);

}  // namespace pkm
