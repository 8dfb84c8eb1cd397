#include "engine/study/take_part.hpp"

#include <algorithm>

#include "engine/core/error.hpp"
#include "engine/core/instruction_set.hpp"
#include "engine/core/ranks.hpp"
#include "engine/problem/replay.hpp"
#include "engine/setup/study_changes.hpp"
#include "engine/setup/text_file.hpp"
#include "engine/study/extension.hpp"
#include "engine/study/records.hpp"
#include "engine/study/run.hpp"
#include "engine/study/stop_request.hpp"

namespace pkm {
namespace {

/// The first byte of what rank 0 broadcasts between runs.
constexpr char kTakePart = 'r', kDismissed = 'q';

/// Up to the end of a line, after which `at` stands then.
std::string next_line(const std::string& text, std::size_t& at) {
  const std::size_t begin = at, end = text.find('\n', at);
  at = end + 1;
  return text.substr(begin, end - begin);
}

/// Rank 0 has read the files, the others have not. Where they see other ones by these names, somebody is mistaken.
void expect_same_files(const StudyContents& contents) {
  const auto compare = [](const std::string& file, const std::string& text) {
    std::string here;
    try {
      here = read_text_file(file, "a text");
    } catch (const ConfigError&) {
      return;  // there is none on this host
    }
    if (without_changes(here) != without_changes(text))
      ranks::abandon(file + " has another text here than for rank 0 on " + ranks::host(0) +
                     ": every rank has to see the same files");
  };
  compare(contents.toml_file, contents.toml);
  if (contents.description) compare(contents.description->file_name, contents.description->text);
}

/// The run that an invitation asks for.
void join_run(const std::string& invitation, const Catalogues& catalogues, const ProgramVersion& program) {
  std::size_t at = 1;
  RunOptions options;
  options.program.version = next_line(invitation, at);
  options.program.revision = next_line(invitation, at);
  if (options.program.version != program.version || options.program.revision != program.revision)
    ranks::abandon("pkmopt " + program.version + " (" + program.revision + ") here, but " + options.program.version +
                   " (" + options.program.revision + ") as rank 0 on " + ranks::host(0) +
                   ": the same program has to run on every host");
  options.program.arguments = next_line(invitation, at);
  if (options.program.arguments != program.arguments)
    ranks::abandon("called as 'pkmopt " + program.arguments + "' here, but as 'pkmopt " + options.program.arguments +
                   "' as rank 0 on " + ranks::host(0) + ": every rank needs the same arguments");
  options.threads = std::stoi(next_line(invitation, at));
  const auto instructions = static_cast<InstructionSet>(std::stoi(next_line(invitation, at)));
  use_instruction_set(std::min(instructions, widest_instruction_set()));
  Progress silent;
  try {
    StudyContents contents = parse_study(invitation.substr(at), kStudySchema);
    if (program.arguments.starts_with("run ")) expect_same_files(contents);
    Study study = study_of(contents, catalogues);
    apply_extensions(study, contents.extensions);
    Run(study, std::move(contents), nullptr, options, silent)();
  } catch (const ReplayMismatch&) {  // rank 0 tells
  } catch (const std::exception& error) {
    ranks::abandon(message_of(error));
  }
}

}  // namespace

std::string invitation(const StudyContents& contents, const RunOptions& options) {
  if (ranks::size() == 1) return "";
  return kTakePart + options.program.version + '\n' + options.program.revision + '\n' + options.program.arguments +
         '\n' + std::to_string(options.threads) + '\n' + std::to_string(static_cast<int>(instruction_set())) + '\n' +
         pack_study(contents);
}

int take_part(const Catalogues& catalogues, const ProgramVersion& program) {
  const StopRequest listen;  // rank 0 decides what a signal to all of them does
  while (true) {
    std::string message;
    ranks::broadcast(message);
    const char kind = message.empty() ? '\0' : message.front();
    if (kind == kDismissed) return std::stoi(message.substr(1));
    if (kind != kTakePart)
      ranks::abandon("this rank has ended a run in which rank 0 on " + ranks::host(0) +
                     " goes on: the same program with the same libraries has to run on every host");
    join_run(message, catalogues, program);
  }
}

void dismiss_ranks(int exit_code) {
  std::string message = kDismissed + std::to_string(exit_code);
  ranks::broadcast(message);
}

}  // namespace pkm
