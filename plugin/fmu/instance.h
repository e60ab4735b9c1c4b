// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "fmu/unit.h"

namespace volcontact::fmu {

/// Of both standards, with the same numbers.
enum Status : int { kOk = 0, kWarning = 1, kDiscard = 2, kError = 3 };

/// Where an instance is in the life that the standards give it; bits, so that a function can name
/// all in which it may be called.
enum Mode : unsigned {
  kInstantiated = 1,
  kInitialization = 2,
  kEvent = 4,
  kContinuous = 8,
  kStep = 16,
  kTerminated = 32,
  kIntermediate = 64,  ///< within the callback of a communication step
};
inline constexpr unsigned kRunning = kInitialization | kEvent | kContinuous | kStep | kIntermediate;
inline constexpr unsigned kAnyMode = 127;

/// A state of an instance to come back to.
struct Saved {
  std::vector<double> memory;
  Mode mode;
};

/// What the instances of FMI 2 and FMI 3 have in common. Functions throw where a call is wrong;
/// run() makes a status and a message of it.
class Instance {
 public:
  Instance(const std::string& resources, const char* token, bool is_exchange);
  virtual ~Instance() = default;

  virtual void log(Status status, const std::string& message) noexcept = 0;

  /// Runs a function of the standard in the modes that it may be called in.
  template <typename Function>
  Status run(const char* name, unsigned modes, Function&& function) noexcept;

  const std::unique_ptr<Unit> owned;
  Unit& unit;
  const bool is_exchange;
  Mode mode = kInstantiated;

  using Type = ValueType;
  /// The group that a value reference begins; throws where there is none of the type.
  const Group& group(unsigned reference, Type type) const;
  /// The group that it is of, as FMI 2 counts.
  const Group& group_of(unsigned reference, Type type) const;
  double get(unsigned reference);
  void set(const Group& group, int offset, const double* numbers, int count);

  void enter_initialization(double start);
  void exit_initialization();
  void reset();
  /// Of `step` seconds from `now`: how far it came. `part_done(time)` is called after each part but
  /// the last and says whether to stop there. `stop_at_touch`: also where bodies meet or part.
  template <typename PartDone>
  double step(double now, double step, bool stop_at_touch, PartDone&& part_done);

  std::unique_ptr<Saved> save() const;
  void restore(const Saved& saved);
  std::size_t saved_size(const Saved& saved) const;
  void serialize(const Saved& saved, void* bytes, std::size_t size) const;
  std::unique_ptr<Saved> deserialize(const void* bytes, std::size_t size) const;

 private:
  void check_mode(const char* function, unsigned modes) const;
  Status report_warnings(const char* function);
  /// Of the exception that is handled.
  Status report_failure(const char* function) noexcept;
  void check_step(double now, double step) const;
  bool is_unchangeable(const Group& group) const;
};

/// The category of the log for a status, as modelDescription.xml names them.
const char* category_of(Status status);

// What is the same for all functions is compiled once.
template <typename Function>
Status Instance::run(const char* name, unsigned modes, Function&& function) noexcept {
  try {
    check_mode(name, modes);
    function();
    return report_warnings(name);
  } catch (...) {
    return report_failure(name);
  }
}

template <typename PartDone>
double Instance::step(double now, double step, bool stop_at_touch, PartDone&& part_done) {
  check_step(now, step);
  const int parts = unit.step_parts(step);
  const std::vector<double> before = parts > 1 ? unit.memory() : std::vector<double>{};
  double done = 0.0;
  try {
    for (int i = 1; i <= parts; ++i) {
      const double to = i == parts ? step : step * i / parts;
      const bool touched = unit.touching();
      unit.step(now, done, to);
      done = to;
      if (stop_at_touch && touched != unit.touching()) break;
      if (i < parts && part_done(now + to)) break;
    }
  } catch (const Discarded&) {
    if (parts > 1) unit.restore(before);
    throw;
  }
  unit.end_step(done);
  return now + done;
}

}  // namespace volcontact::fmu
