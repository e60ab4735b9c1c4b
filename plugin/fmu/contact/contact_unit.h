// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "c_api/volcontact.h"
#include "fmu/unit.h"
#include "volcontact/base/types.h"

namespace volcontact::fmu {

/// Throws where a function of the C container returned an error.
void check(int code);

/// All of a contact unit that lasts.
struct Memory {
  double time = 0.0;
  std::vector<double> values;             ///< of all groups
  std::vector<std::vector<double>> rows;  ///< of each model, as vc_evaluate keeps them
  std::vector<double> twists_before;      ///< of each body at the last communication point
  double step_before = 0.0;               ///< [s], 0: there was none
  double touching_before = 0.0;           ///< whether bodies touched then
  double is_stepping = 0.0;               ///< co-simulation: laws step their states themselves

  std::vector<double> packed() const;
  /// Throws std::invalid_argument where the numbers are of another unit. `this` has its layout.
  void unpack(const double* numbers, std::size_t count);
};

/// Contact models between bodies that the simulator moves; what depends on others is worked out
/// when it is asked for.
class ContactUnit final : public Unit {
 public:
  explicit ContactUnit(const std::string& resources);

  const UnitFile& file() const override { return file_; }
  double time() const override { return memory_.time; }
  void set_time(double time) override;
  void reset() override;

  double get(unsigned reference) override;
  double last(unsigned reference) const override { return memory_.values[reference]; }
  void set(const Group& group, int offset, const double* numbers, int count) override;

  std::vector<double> memory() const override { return memory_.packed(); }
  void restore(const std::vector<double>& memory) override;

  void begin() override;
  int step_parts(double step) const override;
  void step(double start, double from, double to) override;
  void end_step(double step) override;
  bool touching() const override { return touching_; }

  bool offers_exchange() const override { return true; }
  std::size_t state_count() const override { return states_.size(); }
  void get_states(double* x) const override;
  void set_states(const double* x) override;
  void get_rates(double* rates) override;
  void get_nominals(double* nominals) const override;
  std::size_t indicator_count() const override { return 2 * models_.size(); }
  void get_indicators(double* indicators) override;
  bool complete_step() override;
  bool update_states() override;
  void derivative(const unsigned* unknowns, std::size_t unknown_count, const unsigned* knowns,
                  std::size_t known_count, const double* seed, double* sensitivity) override;

 private:
  struct Model {
    std::unique_ptr<vc_model, void (*)(vc_model*)> model{nullptr, &vc_model_free};
    std::unique_ptr<vc_workspace, void (*)(vc_workspace*)> workspace{nullptr, &vc_workspace_free};
    int row = 0;                     ///< numbers of a row
    int first = 0, last = 0;         ///< those of a row that are continuous states
    double slip_speed = 0.0;         ///< from which it slides; 0: unknown
    double bristle_stiffness = 0.0;  ///< [N/m]; 0: no bristles
    std::vector<double> rows, next, rates;
    std::vector<int> slot_of;  ///< of each row of `next`, the committed row it goes on from, or -1
    vc_result result{};
    std::vector<vc_site> sites;
  };
  struct Body {
    Pose X;
    Twist V;
  };

  void check_layout() const;
  void build_model(std::size_t m);
  void apply_parameters();
  void apply_parameter(const Group& group);
  static void read_numbers(Model& model);
  void book_bristles(Model& model, int mine, int committed, const double* rates);
  Body body_at(int body, double later) const;
  vc_motion motion_of(std::size_t m, double later) const;
  void read_bodies();
  void update();
  void evaluate(std::size_t m);
  void match(Model& model) const;
  void put_states(std::size_t m, std::vector<double>& rows) const;
  void publish();
  void publish_model(std::size_t m, std::vector<Wrench>& wrenches);
  void publish_sites(std::size_t m);
  void publish_rates(std::size_t m);
  void find_indicators(double* indicators) const;
  double* values(Role role, int index);
  const double* values(Role role, int index) const;
  void analytic(const std::vector<double>& change, std::vector<double>& wrenches) const;
  std::vector<double> body_change(int body, const std::vector<double>& change) const;

  UnitFile file_;
  std::vector<Model> models_;
  std::vector<int> states_, rates_;       ///< where the continuous states and their derivatives are
  std::vector<std::vector<int>> places_;  ///< of role and index: first value or -1
  Memory memory_;
  std::vector<double> applied_;  ///< the parameters, of all values, that the models have
  std::vector<Body> bodies_;
  double part_at_ = 0.0;           ///< how far a communication step has come [s]
  std::vector<double> inputs_at_;  ///< of each body, how far it was when its inputs were set [s]
  bool out_of_date_ = true;
  bool touching_ = false;
};

}  // namespace volcontact::fmu
