// SPDX-License-Identifier: Apache-2.0

// What a unit of FMI 2.0 costs beside the C call in it: fmu_cost BINARY RESOURCES TOKEN. Poses of
// the first body a little beside its start, in contact; the two take turns, so that a busy machine
// slows both. Prints JSON: microseconds and ratios, medians.
#include <dlfcn.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "c_api/volcontact.h"
#include "fmu/fmi2.h"

namespace {

constexpr int kPoses = 64, kTurns = 60, kBefore = 5;
constexpr double kStep = 1e-4;   // [s]
constexpr double kShift = 2e-4;  // [m]
constexpr unsigned kForce = 13;  // value reference; pose and twist come before it
constexpr std::size_t kInputs = kForce, kWrench = 6;

void require(bool condition, const std::string& what) {
  if (condition) return;
  std::fprintf(stderr, "fmu_cost: %s\n", what.c_str());
  std::exit(1);
}

struct Fmu {
  explicit Fmu(const char* path) : library(dlopen(path, RTLD_NOW | RTLD_LOCAL)) {
    require(library != nullptr, std::string("cannot load ") + path);
  }
  template <typename Function>
  Function* find(const char* name) const {
    auto* found = reinterpret_cast<Function*>(dlsym(library, name));
    require(found != nullptr, std::string("no function ") + name);
    return found;
  }
  void* library;
};

using volcontact::fmi2::Callbacks;
using volcontact::fmi2::EventInfo;

// One instance, started.
class Instance {
 public:
  Instance(const Fmu& fmu, const char* token, const char* resources, bool exchange)
      : set_(fmu.find<int(void*, const unsigned*, std::size_t, const double*)>("fmi2SetReal")),
        get_(fmu.find<int(void*, const unsigned*, std::size_t, double*)>("fmi2GetReal")),
        rates_(fmu.find<int(void*, double*, std::size_t)>("fmi2GetDerivatives")),
        step_(fmu.find<int(void*, double, double, int)>("fmi2DoStep")) {
    static const Callbacks kQuiet{};
    const auto make =
        fmu.find<void*(const char*, int, const char*, const char*, const Callbacks*, int, int)>(
            "fmi2Instantiate");
    c_ = make("cost", exchange ? 0 : 1, token, resources, &kQuiet, 0, 0);
    require(c_ != nullptr, "the unit cannot be instantiated");
    require(fmu.find<int(void*, int, double, double, int, double)>("fmi2SetupExperiment")(
                c_, 0, 0.0, 0.0, 0, 0.0) == 0,
            "no experiment");
    require(fmu.find<int(void*)>("fmi2EnterInitializationMode")(c_) == 0, "no initialization");
    require(fmu.find<int(void*)>("fmi2ExitInitializationMode")(c_) == 0, "no start");
    if (exchange) {
      EventInfo info;
      require(fmu.find<int(void*, EventInfo*)>("fmi2NewDiscreteStates")(c_, &info) == 0,
              "no event");
      require(fmu.find<int(void*)>("fmi2EnterContinuousTimeMode")(c_) == 0, "no time");
    }
    for (unsigned i = 0; i < kInputs; ++i) inputs_.push_back(i);
    for (unsigned i = 0; i < kWrench; ++i) wrench_.push_back(kForce + i);
  }

  void set(const double* values) { require(set_(c_, inputs_.data(), kInputs, values) == 0, "set"); }
  void get(double* values) { require(get_(c_, wrench_.data(), kWrench, values) == 0, "get"); }
  void rates(std::vector<double>& out) {
    require(rates_(c_, out.data(), out.size()) == 0, "rates");
  }
  void step() {
    require(step_(c_, time_, kStep, 1) == 0, "step");
    time_ += kStep;
  }

 private:
  int (*set_)(void*, const unsigned*, std::size_t, const double*);
  int (*get_)(void*, const unsigned*, std::size_t, double*);
  int (*rates_)(void*, double*, std::size_t);
  int (*step_)(void*, double, double, int);
  void* c_ = nullptr;
  double time_ = 0.0;
  std::vector<unsigned> inputs_, wrench_;
};

// The container by itself: the models of the unit, and which of their bodies moves.
struct Container {
  struct Model {
    vc_model* model;
    vc_workspace* workspace;
    bool moves_a;
    std::vector<double> rows, next, rates;
  };
  std::vector<Model> models;
  std::vector<double> start;  // of the inputs
  std::size_t states = 0;

  explicit Container(const std::string& folder) {
    std::istringstream text(content(folder + "/unit.txt"));
    int slots = 0;
    for (std::string line; std::getline(text, line);) {
      std::istringstream words(line);
      std::string word, role;
      words >> word;
      if (word == "slots") words >> slots;
      if (word == "model") {
        int a = 0;
        words >> a;
        add(content(folder + "/model_" + std::to_string(models.size()) + ".txt"), a == 0, slots);
      }
      if (word != "group") continue;
      int index = 0, first = 0, count = 0, tunable = 0;
      std::string name;
      words >> role >> index >> first >> count >> tunable >> name;
      if (role == "state" || role == "dissipated") states += static_cast<std::size_t>(count);
      for (double value; first < static_cast<int>(kInputs) && words >> value;) {
        start.push_back(value);
      }
    }
    require(start.size() == kInputs, "the first body is not free, or has no quaternion");
  }

  void add(const std::string& text, bool moves_a, int slots) {
    Model model{nullptr, nullptr, moves_a, {}, {}, {}};
    require(vc_model_create_text(text.c_str(), &model.model) == 0, vc_error());
    require(vc_workspace_create(&model.workspace) == 0, vc_error());
    const int size = vc_model_state_size(model.model, slots);
    model.rows.assign(static_cast<std::size_t>(std::max(size, 0)), 0.0);
    model.next = model.rates = model.rows;
    models.push_back(std::move(model));
  }

  static std::string content(const std::string& path) {
    std::ifstream file(path);
    require(file.good(), "cannot read " + path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

  // As Model Exchange (elapsed = 0) and Co-Simulation call it. Returns the number of sites.
  int evaluate(const std::vector<vc_motion>& motions, double elapsed) {
    int sites = 0;
    for (std::size_t m = 0; m < models.size(); ++m) {
      Model& model = models[m];
      vc_result result;
      const int size = static_cast<int>(model.rows.size());
      int code = 0;
      if (size == 0) {
        code = vc_evaluate(model.model, model.workspace, &motions[m], nullptr, nullptr, 0, elapsed,
                           &result);
      } else if (elapsed == 0.0) {
        code = vc_evaluate_rates(model.model, model.workspace, &motions[m], model.rows.data(),
                                 model.next.data(), model.rates.data(), size, &result);
      } else {
        code = vc_evaluate(model.model, model.workspace, &motions[m], model.rows.data(),
                           model.next.data(), size, elapsed, &result);
        model.rows.swap(model.next);
      }
      require(code == 0, vc_error());
      sites += result.sites;
    }
    return sites;
  }

  // Of each model, for a pose and twist of the inputs.
  std::vector<vc_motion> motions(const double* in) const {
    std::vector<vc_motion> all;
    for (const Model& model : models) {
      vc_motion motion{};
      double pose[16];
      fill_pose(in, pose);
      double fixed[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
      std::copy_n(model.moves_a ? pose : fixed, 16, motion.X_WA);
      std::copy_n(model.moves_a ? fixed : pose, 16, motion.X_WB);
      std::copy_n(in + 7, 6, model.moves_a ? motion.V_WA : motion.V_WB);
      all.push_back(motion);
    }
    return all;
  }

  static void fill_pose(const double* in, double* m) {
    const double norm = std::hypot(std::hypot(in[3], in[4]), std::hypot(in[5], in[6]));
    const double w = in[3] / norm, x = in[4] / norm, y = in[5] / norm, z = in[6] / norm;
    const double rows[] = {1 - 2 * (y * y + z * z),
                           2 * (x * y - w * z),
                           2 * (x * z + w * y),
                           in[0],
                           2 * (x * y + w * z),
                           1 - 2 * (x * x + z * z),
                           2 * (y * z - w * x),
                           in[1],
                           2 * (x * z - w * y),
                           2 * (y * z + w * x),
                           1 - 2 * (x * x + y * y),
                           in[2],
                           0,
                           0,
                           0,
                           1};
    std::copy(std::begin(rows), std::end(rows), m);
  }
};

// Of one pose [us].
template <typename Function>
double time_of(Function&& function) {
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < kPoses; ++i) function(static_cast<std::size_t>(i));
  const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - begin;
  return took.count() / kPoses;
}

double median(std::vector<double> numbers) {
  std::sort(numbers.begin(), numbers.end());
  return numbers[numbers.size() / 2];
}

}  // namespace

int main(int count, char** arguments) {
  require(count == 4, "fmu_cost BINARY RESOURCES TOKEN");
  const Fmu fmu(arguments[1]);
  Container container(arguments[2]), stepped(arguments[2]);
  Instance exchange(fmu, arguments[3], arguments[2], true);
  Instance simulation(fmu, arguments[3], arguments[2], false);
  std::mt19937 random(1);
  std::uniform_real_distribution<> shift(-kShift, kShift);
  std::vector<std::vector<double>> inputs;
  std::vector<std::vector<vc_motion>> motions;
  int sites = 0;
  for (int i = 0; i < kPoses; ++i) {
    std::vector<double> one = container.start;
    for (std::size_t k = 0; k < 3; ++k) one[k] += shift(random);
    motions.push_back(container.motions(one.data()));
    inputs.push_back(std::move(one));
    sites += container.evaluate(motions.back(), 0.0);
  }
  require(sites > 0, "no contact");
  std::vector<double> call, rates, called_step, step, rates_ratio, step_ratio;
  std::vector<double> derivatives(container.states);
  double wrench[kWrench], sum = 0.0;
  for (int turn = 0; turn < kTurns; ++turn) {
    const double a = time_of([&](std::size_t i) { sum += container.evaluate(motions[i], 0.0); });
    const double b = time_of([&](std::size_t i) {
      exchange.set(inputs[i].data());
      exchange.rates(derivatives);
      exchange.get(wrench);
      sum += wrench[0];
    });
    const double c = time_of([&](std::size_t i) { sum += stepped.evaluate(motions[i], kStep); });
    const double d = time_of([&](std::size_t i) {
      simulation.set(inputs[i].data());
      simulation.step();
      simulation.get(wrench);
      sum += wrench[0];
    });
    if (turn < kBefore) continue;
    call.push_back(a), rates.push_back(b), called_step.push_back(c), step.push_back(d);
    rates_ratio.push_back(b / a), step_ratio.push_back(d / c);
  }
  std::printf(
      "{\"models\": %zu, \"sites\": %.1f, \"call_us\": %.2f, \"get_derivatives_us\": %.2f, "
      "\"get_derivatives_ratio\": %.3f, \"step_call_us\": %.2f, \"do_step_us\": %.2f, "
      "\"do_step_ratio\": %.3f}\n",
      container.models.size(), static_cast<double>(sites) / kPoses, median(call), median(rates),
      median(rates_ratio), median(called_step), median(step), median(step_ratio));
  return std::isfinite(sum) ? 0 : 1;
}
