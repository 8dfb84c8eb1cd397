// The program with objectives that test its ranks; `--exchange` tests the messages alone.
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
  if (!holds) ranks::abandon(what);
}

std::string bytes(std::size_t count, int seed) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += static_cast<char>((i * 31 + static_cast<std::size_t>(seed)) % 251);
  return text;
}

/// Every kind of message between ranks, with sizes around those where their way changes.
void exchange() {
  const int own = ranks::rank(), ranks = ranks::size();
  for (const std::size_t count : {0, 1, 119, 120, 121, 100'000}) {
    std::string message = bytes(own == 0 ? count : 7, own);
    ranks::broadcast(message);
    expect(message == bytes(count, 0), "broadcast");
    for (const std::size_t more : {0, 1000}) {
      const auto size_of = [&](int rank) { return count + more * static_cast<std::size_t>(rank); };
      const auto all = ranks::all_gather(bytes(size_of(own), own));
      expect(std::ssize(all) == ranks, "all_gather gives one each");
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
        share_pieces(2, [&](std::size_t begin, std::size_t end) {
          for (std::size_t piece = begin; piece < end; ++piece)
            for (int i = 0; i < kEach; ++i) claimed[piece] += std::to_string(counter.next(count)) + ' ';
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
    ranks::post(std::to_string(own) + ' ' + std::to_string(i) + bytes(i == 50 ? 200'000 : 0, 1));
  std::vector<int> next(static_cast<std::size_t>(ranks), 0);
  if (own == 0)
    for (int received = 0; received < kMessages * ranks;)
      if (const auto message = ranks::poll()) {
        int from = 0, number = 0;
        expect(std::sscanf(message->c_str(), "%d %d", &from, &number) == 2, "post");
        expect(number == next[static_cast<std::size_t>(from)]++, "posts of one rank come in order");
        ++received;
      }
  expect(own > 0 || !ranks::poll(), "no message is left");
  ranks::all_gather("");
  ranks::post("what nobody asks for does not hold up the end");
  if (own == 0) std::printf("%d ranks exchange\n", ranks);
}

/// An objective whose value is the parameter a (or, `odd`, almost) after a time that grows with it, to 4 ms.
ObjectiveEntry slow(const std::string& name, bool odd, double seconds) {
  return {.name = name,
          .meaning = "the parameter a, late",
          .make =
              [=](const EntryContext&) {
                return make_plain_quantity(
                    [=](const DesignView<double>& design) {
                      const double a = design.parameters[0];
                      std::this_thread::sleep_for(std::chrono::duration<double>(a * seconds));
                      return odd && ranks::rank() == 1 ? a * (1 + 1e-15) : a;
                    },
                    "it is a test's");
              },
          .reads_survey = false};
}

}  // namespace
}  // namespace pkm

int main(int argc, char** argv) {
  if (argc == 2 && std::strcmp(argv[1], "--exchange") == 0) {
    const pkm::ranks::Group group;
    pkm::exchange();
    return 0;
  }
  pkm::Catalogues all = pkm::all_catalogues();
  all.objectives.push_back(pkm::slow("slow", false, 4e-3));
  all.objectives.push_back(pkm::slow("odd", true, 1e-5));
  return pkm::program_main(argc, argv, all);
}
