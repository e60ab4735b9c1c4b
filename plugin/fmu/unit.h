// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "fmu/unit_file.h"

namespace volcontact::fmu {

/// A value that cannot be used now, such as a quaternion of norm 0: the caller may change it and go
/// on. Anything else that is wrong is std::invalid_argument.
struct Discarded : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What FMI 2 and FMI 3 ask of a unit, whatever is in it: contact models or a whole scene. Values
/// are read and written by value reference.
class Unit {
 public:
  virtual ~Unit() = default;

  virtual const ValueFile& file() const = 0;
  const Group* group(unsigned reference) const;  ///< that begins there; null: none
  const Group* group_around(unsigned reference) const;

  virtual double time() const = 0;
  virtual void set_time(double time) = 0;
  virtual void reset() = 0;

  /// Reads a value, working out what is out of date. Throws Discarded.
  virtual double get(unsigned reference) = 0;
  /// Reads it as it is.
  virtual double last(unsigned reference) const = 0;
  /// Throws Discarded on a number that is not finite or a parameter out of range; nothing changes.
  virtual void set(const Group& group, int offset, const double* numbers, int count) = 0;

  /// All of it that lasts: with the same memory it goes on with the same bits.
  virtual std::vector<double> memory() const = 0;
  /// Throws std::invalid_argument where the memory is of another unit.
  virtual void restore(const std::vector<double>& memory) = 0;

  // Co-simulation.
  virtual void begin() = 0;  ///< at the start time: sites that are there are old
  virtual int step_parts(double step) const = 0;
  /// One part of a communication step that began at `start`, `from` to `to` seconds after it.
  virtual void step(double start, double from, double to) = 0;
  virtual void end_step(double step) = 0;
  virtual bool touching() const = 0;
  /// What to tell the author of the simulation since the last call, one a line.
  virtual std::string take_warnings() { return {}; }

  // Continuous states and event indicators, as Model Exchange has them.
  virtual bool offers_exchange() const { return false; }
  virtual std::size_t state_count() const { return 0; }
  virtual void get_states(double* /*x*/) const {}
  virtual void set_states(const double* /*x*/) {}
  virtual void get_rates(double* /*rates*/) {}
  virtual void get_nominals(double* /*nominals*/) const {}
  virtual std::size_t indicator_count() const { return 0; }
  virtual void get_indicators(double* /*indicators*/) {}
  /// Takes the sites of now over; whether an event must say that others are there.
  virtual bool complete_step() { return false; }
  /// Takes them over with their states; whether continuous states changed.
  virtual bool update_states() { return false; }
  /// sensitivity = d(unknown)/d(known) seed.
  virtual void derivative(const unsigned* /*unknowns*/, std::size_t /*unknown_count*/,
                          const unsigned* /*knowns*/, std::size_t /*known_count*/,
                          const double* /*seed*/, double* /*sensitivity*/) {}

 protected:
  /// Once the file is read.
  void index_groups();

  /// Throws Discarded where a number to be set is none.
  static void require_finite(const Group& group, int offset, const double* numbers, int count);

 private:
  std::vector<int> group_of_;  ///< of each value
};

/// The unit that the resources of an FMU describe. Throws std::invalid_argument naming the file.
std::unique_ptr<Unit> make_unit(const std::string& resources);

}  // namespace volcontact::fmu
