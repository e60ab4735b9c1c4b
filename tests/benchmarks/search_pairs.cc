// SPDX-License-Identifier: Apache-2.0

// Random search for wrong answers: search_pairs FAMILY SEED FIRST COUNT [LEVEL|answers]
// Prints lines of JSON that tests/benchmarks/search_for_failures.py adds up: one of every failure,
// and at the end one with the counts and a hash of all answers. After a crash the last line names
// the case. LEVEL, 0 to 5, is how closely the judge looks at every case, instead of at one in 20
// and in 500; `answers` asks no judge and prints the hash alone: where it is the same on other
// engines, what was found on those holds.
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <limits>
#include <map>
#include <stdexcept>

#include "core/reference/line_oracle.h"
#include "core/search/pair_search.h"

namespace {

using namespace volcontact;
using namespace volcontact::test;

constexpr unsigned kPatience = 120;  // [s] of one case

volatile std::sig_atomic_t current = 0;

// What is left of a case that ends the program: its number.
extern "C" void on_signal(int signal) {
  char text[80];
  const int length = std::snprintf(text, sizeof text, "{\"crash\": %d, \"index\": %ld}\n", signal,
                                   static_cast<long>(current));
  if (write(STDOUT_FILENO, text, static_cast<std::size_t>(length)) < 0) _exit(4);
  _exit(3);
}

SearchFamily family_of(const char* name) {
  for (const SearchFamily family : kSearchFamilies) {
    if (std::strcmp(name, to_string(family)) == 0) return family;
  }
  throw std::invalid_argument(std::string("no family of cases is named ") + name);
}

// The judge looks closely at one case in twenty, and more closely at one in 500.
int level_of(std::uint64_t index) { return index % 500 == 499 ? 3 : index % 20 == 19 ? 2 : 1; }

struct Count {
  int cases = 0, overlapping = 0, undecided = 0;
  int known[4] = {};  // overlaps of which the judge knew V to 1e-2, 1e-3, 1e-4, 1e-5
  double slowest = 0.0;
};

// JSON has no infinity.
double finite(double x) {
  return std::isfinite(x) ? x : std::copysign(std::numeric_limits<double>::max(), x);
}

void print(const SearchFailure& f, SearchFamily family, std::uint64_t index) {
  std::printf(
      "{\"what\": \"%s\", \"family\": \"%s\", \"index\": %llu, \"engine\": \"%s\", "
      "\"status\": \"%s\", \"volume\": %.17g, \"volume_error\": %.4g, \"expected\": %.17g, "
      "\"doubt\": %.4g, \"a\": \"%s\", \"b\": \"%s\", \"X_AB\": \"%s\"}\n",
      f.what.c_str(), to_string(family), static_cast<unsigned long long>(index),
      to_string(f.engine), to_string(f.status), finite(f.volume), finite(f.volume_error),
      finite(f.expected), finite(f.doubt), f.a.c_str(), f.b.c_str(), f.X_AB.c_str());
}

// Also where nothing is judged: what is asked must not depend on it.
std::uint64_t seed_of(std::uint64_t seed, std::uint64_t index) { return seed + 1000003 * index; }

int answers(SearchFamily family, std::uint64_t seed, std::uint64_t first, std::uint64_t count) {
  PairSearch search;
  SearchCases cases(family, seed);
  std::uint64_t sum = 0;
  for (std::uint64_t index = first; index < first + count; ++index) {
    current = static_cast<std::sig_atomic_t>(index);
    alarm(kPatience);
    try {
      sum = 31 * sum + search.ask(cases[index], seed_of(seed, index)).answers;
    } catch (const std::invalid_argument&) {
    }
  }
  std::printf("{\"answers\": \"%016llx\"}\n", static_cast<unsigned long long>(sum));
  return 0;
}

int search(SearchFamily family, std::uint64_t seed, std::uint64_t first, std::uint64_t count,
           int level) {
  std::uint64_t sum = 0;
  PairSearch search;
  SearchCases cases(family, seed);
  std::map<std::string, Count> counts;
  int refused = 0;
  for (std::uint64_t index = first; index < first + count; ++index) {
    current = static_cast<std::sig_atomic_t>(index);
    alarm(kPatience);
    SearchCase c;
    try {
      c = cases[index];
    } catch (const std::invalid_argument&) {
      ++refused;  // solids that are none
      continue;
    }
    const SearchOutcome outcome =
        search.run(c, level >= 0 ? level : level_of(index), seed_of(seed, index));
    sum = 31 * sum + outcome.answers;
    Count& tally = counts[to_string(outcome.engine)];
    ++tally.cases;
    tally.overlapping += outcome.overlapping;
    tally.undecided += outcome.undecided;
    tally.slowest = std::max(tally.slowest, outcome.seconds);
    double least = 1e-2;
    for (int& known : tally.known) {
      known += outcome.overlapping && !outcome.undecided && outcome.doubt < least;
      least *= 0.1;
    }
    for (const SearchFailure& failure : outcome.failures) print(failure, family, index);
    if (!outcome.failures.empty()) std::fflush(stdout);
  }
  for (const auto& [engine, tally] : counts) {
    std::printf(
        "{\"count\": \"%s\", \"family\": \"%s\", \"cases\": %d, \"overlapping\": %d, "
        "\"undecided\": %d, \"slowest\": %.3g, \"known\": [%d, %d, %d, %d]}\n",
        engine.c_str(), to_string(family), tally.cases, tally.overlapping, tally.undecided,
        tally.slowest, tally.known[0], tally.known[1], tally.known[2], tally.known[3]);
  }
  std::printf("{\"refused\": %d, \"seconds\": %.2f, \"answers\": \"%016llx\"}\n", refused,
              static_cast<double>(std::clock()) / CLOCKS_PER_SEC,
              static_cast<unsigned long long>(sum));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const bool ask = argc == 6 && std::strcmp(argv[5], "answers") == 0;
  const int level = argc == 6 && !ask ? std::atoi(argv[5]) : -1;
  if (argc < 5 || argc > 6 || level >= LineOracle::kLevels) {
    std::fprintf(stderr, "usage: search_pairs FAMILY SEED FIRST COUNT [LEVEL|answers]\n");
    return 2;
  }
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGALRM}) std::signal(signal, on_signal);
  try {
    const SearchFamily family = family_of(argv[1]);
    const std::uint64_t seed = std::strtoull(argv[2], nullptr, 10),
                        first = std::strtoull(argv[3], nullptr, 10),
                        count = std::strtoull(argv[4], nullptr, 10);
    if (ask) return answers(family, seed, first, count);
    return search(family, seed, first, count, level);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "search_pairs: %s\n", error.what());
    return 2;
  }
}
