#include "engine/runner/worker_ranks.hpp"

#include <algorithm>

#include "engine/config/study_changes.hpp"
#include "engine/config/text_file.hpp"
#include "engine/config/upgrade.hpp"
#include "engine/core/error.hpp"
#include "engine/core/instruction_set.hpp"
#include "engine/core/ranks.hpp"
#include "engine/core/team.hpp"
#include "engine/problem/replay.hpp"
#include "engine/runner/extension.hpp"
#include "engine/runner/python_functions.hpp"
#include "engine/runner/records.hpp"
#include "engine/runner/run.hpp"
#include "engine/runner/stop_request.hpp"

namespace pkm {
namespace {

/// First byte of the messages by which MPI rank 0 starts a run, or ends the worker ranks.
constexpr char kRun = 'r', kQuit = 'q';

/// The line of `text` that begins at position `at`. The position is advanced to the next line.
std::string next_line(const std::string& text, std::size_t& at) {
  const std::size_t begin = at, end = text.find('\n', at);
  at = end + 1;
  return text.substr(begin, end - begin);
}

/// Ends all MPI ranks if this host has a study or mechanism file whose contents differ from those that rank 0 has read:
/// the user then probably assumes that this rank uses its own file.
void expect_same_files(const StudyContents& contents) {
  const auto compare = [](const std::string& file, const std::string& recorded, TextKind kind) {
    const std::string text = upgraded(recorded, kind).text;
    std::string local;
    try {
      local = read_text_file(file, "a text");
    } catch (const ConfigError&) {
      return;  // the file does not exist on this host
    }
    if (without_changes(local) != without_changes(text))
      ranks::abort_all_ranks(file + ": differs from the file read on rank 0 (" + ranks::host(0) +
                             "); all ranks must see the same files");
  };
  compare(contents.toml_file, contents.toml, TextKind::study);
  if (contents.description) compare(contents.description->file_name, contents.description->text, TextKind::mechanism);
}

/// Executes the run that a message of MPI rank 0 describes.
void join_run(const std::string& message, const Catalogues& catalogues, const ProgramVersion& program) {
  std::size_t at = 1;
  RunOptions options;
  options.program.version = next_line(message, at);
  options.program.revision = next_line(message, at);
  if (options.program.version != program.version || options.program.revision != program.revision)
    ranks::abort_all_ranks("found pkmopt " + program.version + " (" + program.revision + "), but " +
                           options.program.version + " (" + options.program.revision + ") on rank 0 (" +
                           ranks::host(0) + "); every host must run the same program");
  options.program.arguments = next_line(message, at);
  if (options.program.arguments != program.arguments)
    ranks::abort_all_ranks("called as 'pkmopt " + program.arguments + "', but as 'pkmopt " + options.program.arguments +
                           "' on rank 0 (" + ranks::host(0) + "); all ranks need the same arguments");
  options.threads = std::stoi(next_line(message, at));
  options.python.workers = std::stoi(next_line(message, at));
  const auto instructions = static_cast<InstructionSet>(std::stoi(next_line(message, at)));
  use_instruction_set(std::min(instructions, widest_instruction_set()));
  Progress silent;
  try {
    StudyContents contents = parse_study(message.substr(at), kStudySchema);
    if (program.arguments.starts_with("run ")) expect_same_files(contents);
    Study study = study_of(contents, catalogues);
    if (contents.functions)
      start_python_workers(study, {folder_of(contents.toml_file), ""}, *contents.functions, options.python,
                           team_size(options.threads > 0 ? options.threads : ranks::threads()));
    apply_extensions(study, contents.extensions);
    Run(study, std::move(contents), nullptr, options, silent)();
  } catch (const ReplayMismatch&) {  // rank 0 reports the error
  } catch (const std::exception& error) {
    ranks::abort_all_ranks(message_of(error));
  }
}

}  // namespace

std::string run_message(const StudyContents& contents, const RunOptions& options) {
  if (ranks::size() == 1) return "";
  return kRun + options.program.version + '\n' + options.program.revision + '\n' + options.program.arguments + '\n' +
         std::to_string(options.threads) + '\n' + std::to_string(options.python.workers) + '\n' +
         std::to_string(static_cast<int>(instruction_set())) + '\n' + serialise_study(contents);
}

int run_worker_rank(const Catalogues& catalogues, const ProgramVersion& program) {
  const StopRequest stop_request;  // rank 0 handles the signals that are sent to all ranks
  while (true) {
    std::string message;
    ranks::broadcast(message);
    const char kind = message.empty() ? '\0' : message.front();
    if (kind == kQuit) return std::stoi(message.substr(1));
    if (kind != kRun)
      ranks::abort_all_ranks("this rank has ended a run that rank 0 (" + ranks::host(0) +
                             ") continues; every host must run the same program with the same libraries");
    join_run(message, catalogues, program);
  }
}

void stop_worker_ranks(int exit_code) {
  std::string message = kQuit + std::to_string(exit_code);
  ranks::broadcast(message);
}

}  // namespace pkm
