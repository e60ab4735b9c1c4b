// SPDX-License-Identifier: Apache-2.0
#include "fmu/instance.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>

#include "volcontact/base/check.h"

namespace volcontact::fmu {
namespace {

// Of a serialized state: this, the mode, the count of what follows, a check.
constexpr double kMagic = 2804.0;
constexpr std::size_t kHeadNumbers = 4;

// Of a state of the unit with this token, as a whole number that a double holds: FNV-1a.
double check_of(const std::string& token, Mode mode, const std::vector<double>& memory) {
  std::uint64_t hash = 14695981039346656037ULL;
  const auto add = [&](const void* bytes, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) {
      hash = (hash ^ static_cast<const unsigned char*>(bytes)[i]) * 1099511628211ULL;
    }
  };
  add(token.data(), token.size());
  add(&mode, sizeof mode);
  add(memory.data(), sizeof(double) * memory.size());
  return static_cast<double>(hash >> 12);
}

const char* mode_name(Mode mode) {
  switch (mode) {
    case kInstantiated:
      return "Instantiated";
    case kInitialization:
      return "Initialization Mode";
    case kEvent:
      return "Event Mode";
    case kContinuous:
      return "Continuous-Time Mode";
    case kStep:
      return "Step Mode";
    case kIntermediate:
      return "Intermediate Update Mode";
    case kTerminated:
      break;
  }
  return "Terminated";
}

const char* type_name(Instance::Type type) {
  constexpr const char* kNames[] = {"a real number", "an integer", "a Boolean"};
  return kNames[static_cast<int>(type)];
}

const Group& checked(const Group* group, unsigned reference, Instance::Type type) {
  require(group && group->type() == type, "value reference " + std::to_string(reference) +
                                              " is not that of " + type_name(type) +
                                              " of this FMU; see modelDescription.xml");
  return *group;
}

}  // namespace

const char* category_of(Status status) {
  return status == kWarning   ? "logStatusWarning"
         : status == kDiscard ? "logStatusDiscard"
                              : "logStatusError";
}

Instance::Instance(const std::string& resources, const char* token, bool exchange)
    : owned(make_unit(resources)), unit(*owned), is_exchange(exchange) {
  require(token && unit.file().token == token,
          "the token of the modelDescription.xml is not that of the resources (" +
              unit.file().token + "); export the FMU again");
  require(!is_exchange || unit.offers_exchange(), "this FMU has Co-Simulation only");
}

void Instance::check_mode(const char* function, unsigned modes) const {
  if (mode & modes) return;
  throw std::invalid_argument(std::string(function) + " is not allowed in " + mode_name(mode));
}

Status Instance::report_warnings(const char* function) {
  const std::string warnings = unit.take_warnings();
  if (warnings.empty()) return kOk;
  log(kWarning, std::string(function) + ": " + warnings);
  return kWarning;
}

Status Instance::report_failure(const char* function) noexcept {
  try {
    try {
      throw;
    } catch (const Discarded& error) {
      log(kDiscard, std::string(function) + ": " + error.what());
      return kDiscard;
    } catch (const std::exception& error) {
      log(kError, std::string(function) + ": " + error.what());
      return kError;
    }
  } catch (...) {  // no memory for the message
    return kError;
  }
}

const Group& Instance::group(unsigned reference, Type type) const {
  return checked(unit.group(reference), reference, type);
}
const Group& Instance::group_of(unsigned reference, Type type) const {
  return checked(unit.group_around(reference), reference, type);
}

double Instance::get(unsigned reference) {
  if (mode == kTerminated) return unit.last(reference);
  return unit.get(reference);
}

// Whether a value has no business being set at all, or no longer.
bool Instance::is_unchangeable(const Group& group) const {
  const bool before_start = mode == kInstantiated || mode == kInitialization;
  if (group.is_input()) return false;
  if (group.is_state()) return !before_start;
  if (!group.is_parameter()) return true;
  return !before_start && !(group.is_tunable && (mode == kEvent || mode == kStep));
}

void Instance::set(const Group& group, int offset, const double* numbers, int count) {
  require(!is_unchangeable(group), "value reference " + std::to_string(group.first + offset) +
                                       " cannot be set in " + mode_name(mode));
  unit.set(group, offset, numbers, count);
}

void Instance::enter_initialization(double start) {
  require(std::isfinite(start), "the start time is no finite number");
  unit.set_time(start);
  mode = kInitialization;
}

void Instance::exit_initialization() {
  if (!is_exchange) unit.begin();
  mode = is_exchange ? kEvent : kStep;
}

void Instance::reset() {
  unit.reset();
  mode = kInstantiated;
}

void Instance::check_step(double now, double step) const {
  require(step > 0.0 && std::isfinite(step),
          "the communication step is " + std::to_string(step) + " [s], must be above 0");
  const double off = std::abs(now - unit.time());
  require(off <= 1e-9 * (1.0 + std::abs(now)) && std::isfinite(now),
          "the communication point is " + std::to_string(now) + " [s] and the unit stands at " +
              std::to_string(unit.time()) + " [s]; go back with a saved state");
}

std::unique_ptr<Saved> Instance::save() const {
  return std::make_unique<Saved>(Saved{unit.memory(), mode});
}

void Instance::restore(const Saved& saved) {
  unit.restore(saved.memory);
  mode = saved.mode;
}

std::size_t Instance::saved_size(const Saved& saved) const {
  return sizeof(double) * (kHeadNumbers + saved.memory.size());
}

void Instance::serialize(const Saved& saved, void* bytes, std::size_t size) const {
  require(bytes && size >= saved_size(saved), "the buffer is smaller than the state");
  std::vector<double> numbers{kMagic, static_cast<double>(saved.mode),
                              static_cast<double>(saved.memory.size()),
                              check_of(unit.file().token, saved.mode, saved.memory)};
  numbers.insert(numbers.end(), saved.memory.begin(), saved.memory.end());
  std::memcpy(bytes, numbers.data(), sizeof(double) * numbers.size());
}

std::unique_ptr<Saved> Instance::deserialize(const void* bytes, std::size_t size) const {
  const char* const wrong = "the bytes are not a state of this unit";
  const std::size_t count = size / sizeof(double);
  require(bytes && size % sizeof(double) == 0 && count >= kHeadNumbers, wrong);
  std::vector<double> numbers(count);
  std::memcpy(numbers.data(), bytes, size);
  require(numbers[0] == kMagic && numbers[1] >= 1.0 && numbers[1] <= kAnyMode &&
              numbers[2] == static_cast<double>(count - kHeadNumbers),
          wrong);
  const auto mode_bits = static_cast<unsigned>(numbers[1]);
  require((mode_bits & (mode_bits - 1)) == 0, wrong);
  auto saved = std::make_unique<Saved>(
      Saved{{numbers.begin() + kHeadNumbers, numbers.end()}, static_cast<Mode>(mode_bits)});
  require(numbers[3] == check_of(unit.file().token, saved->mode, saved->memory), wrong);
  return saved;
}

}  // namespace volcontact::fmu
