// pkmopt with additional objectives for tests of ranks; `--exchange` checks only the messages between ranks.
#include <chrono>
#include <cstdio>
#include <cstring>
#include <set>
#include <thread>

#include "engine/core/ranks.hpp"
#include "engine/core/team.hpp"
#include "experiments/app/program.hpp"

namespace pkm {
namespace {

void expect(bool holds, const char* what) {
  if (!holds) ranks::abort_all_ranks(what);
}

std::string bytes(std::size_t count, int seed) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += static_cast<char>((i * 31 + static_cast<std::size_t>(seed)) % 251);
  return text;
}

/// Checks every kind of message between ranks, with sizes around those at which the transport protocol changes.
void check_messages() {
  const int own_rank = ranks::rank(), ranks = ranks::size();
  for (const std::size_t count : {0, 1, 119, 120, 121, 100'000}) {
    std::string message = bytes(own_rank == 0 ? count : 7, own_rank);
    ranks::broadcast(message);
    expect(message == bytes(count, 0), "broadcast");
    for (const std::size_t more : {0, 1000}) {
      const auto size_of = [&](int rank) { return count + more * static_cast<std::size_t>(rank); };
      const auto all = ranks::all_gather(bytes(size_of(own_rank), own_rank));
      expect(std::ssize(all) == ranks, "all_gather returns one message per rank");
      for (int rank = 0; rank < ranks; ++rank)
        expect(all[static_cast<std::size_t>(rank)] == bytes(size_of(rank), rank), "all_gather");
    }
  }
  for (const int count : {1, 3}) {
    constexpr int kEach = 500;
    std::vector<std::string> claimed(2);
    {
      ranks::Counter counter;
      with_team(2, [&] {
        parallel_for(2, [&](std::size_t begin, std::size_t end) {
          for (std::size_t item = begin; item < end; ++item)
            for (int i = 0; i < kEach; ++i) claimed[item] += std::to_string(counter.next(count)) + ' ';
        });
      });
    }
    std::set<long> all;
    for (const std::string& each : ranks::all_gather(claimed[0] + claimed[1]))
      for (std::size_t at = 0; at < each.size(); at = each.find(' ', at) + 1) all.insert(std::atol(each.c_str() + at));
    const long claims = 2L * kEach * ranks;
    expect(std::ssize(all) == claims && *all.begin() == 0 && *all.rbegin() == (claims - 1) * count, "counter");
  }
  constexpr int kMessages = 100;
  for (int i = 0; i < kMessages; ++i)
    ranks::post(std::to_string(own_rank) + ' ' + std::to_string(i) + bytes(i == 50 ? 200'000 : 0, 1));
  std::vector<int> next(static_cast<std::size_t>(ranks), 0);
  if (own_rank == 0)
    for (int received = 0; received < kMessages * ranks;)
      if (const auto message = ranks::poll()) {
        int from = 0, number = 0;
        expect(std::sscanf(message->c_str(), "%d %d", &from, &number) == 2, "post");
        expect(number == next[static_cast<std::size_t>(from)]++, "messages of one rank arrive in order");
        ++received;
      }
  expect(own_rank > 0 || !ranks::poll(), "all messages have been received");
  ranks::all_gather("");
  ranks::post("a message that is not received does not block the end");
  if (own_rank == 0) std::printf("%d ranks: all messages received\n", ranks);
}

/// An objective that returns the parameter a after a * `seconds`.
/// @param inconsistent  rank 1 returns a slightly different value
ObjectiveEntry slow_objective(const std::string& name, bool inconsistent, double seconds) {
  return {.name = name,
          .meaning = "the parameter a, after a delay",
          .make =
              [=](const EntryContext&) {
                return make_quantity_without_derivatives(
                    [=](const DesignView<double>& design) {
                      const double a = design.parameters[0];
                      std::this_thread::sleep_for(std::chrono::duration<double>(a * seconds));
                      return inconsistent && ranks::rank() == 1 ? a * (1 + 1e-15) : a;
                    },
                    "it is an objective for tests");
              },
          .uses_workspace = false};
}

}  // namespace
}  // namespace pkm

int main(int argc, char** argv) {
  if (argc == 2 && std::strcmp(argv[1], "--exchange") == 0) {
    const pkm::ranks::Group group;
    pkm::check_messages();
    return 0;
  }
  pkm::Catalogues all = pkm::all_catalogues();
  all.objectives.push_back(pkm::slow_objective("slow", false, 4e-3));
  all.objectives.push_back(pkm::slow_objective("inconsistent", true, 1e-5));
  return pkm::program_main(argc, argv, all);
}
