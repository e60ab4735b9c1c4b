// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "volcontact/model/contact_report.h"

// The one place that knows how volcontact uses mjData.userdata. All that lasts from one evaluation
// to the next lies there, so that copies, resets and checkpoints of mjData are exact.
//
// Our block is the end of userdata; what comes before it belongs to the user:
//
//   [ user's numbers | motion | solved | slots: kSlots x slot_size | ledger | header: kHeader ]
//
// Ledger and header keep their place when the number of law states changes. All zero, as mjData is
// made and reset, means "never evaluated".

namespace volcontact::adaptor {

/// Sizes of the block, in numbers.
struct UserdataLayout {
  static constexpr int kVersion = 10;
  static constexpr int kHeader = 9;
  /// A Runge-Kutta step and the one before it, which a step that is redone needs.
  static constexpr int kSlots = 5;
  /// Time, step, stage, elastic energy, dissipated x4, power x4, taken x4, bristle energy x2,
  /// power into the elastic energy, whether the step is implicit, work, numerical, power of the
  /// forces x2, elastic energy that nobody paid, work of mocap bodies, energy made in the step,
  /// energy released, so far and by the step that follows, power of friction, energy lent.
  /// Behind it the generalized forces, those of friction alone, the mocap bodies, the law states
  /// and the energies of the pairs.
  static constexpr int kSlotHead = 31;
  /// A HeldSite.
  static constexpr int kSolvedRow = 11;

  int states = 0;       ///< numbers in which sites and energies of all pairs are kept
  int channels = 0;     ///< forces in the ledger: nv for applied, 6 nbody for xfrc, 0 for passive
  int solved_rows = 0;  ///< sites whose solved forces are kept, of the newest evaluation
  int dofs = 0;         ///< nv: generalized forces in a slot
  int motion = 0;       ///< nq + nv: positions and velocities of the newest evaluation
  int mocaps = 0;       ///< numbers of the mocap bodies in a slot: mocap_motion.h

  int slot_size() const { return kSlotHead + 2 * dofs + mocaps + states; }
  int ledger_size() const { return 2 * channels; }
  int solved_size() const { return solved_rows > 0 ? 1 + dofs + kSolvedRow * solved_rows : 0; }
  int size() const {
    return motion + solved_size() + kSlots * slot_size() + ledger_size() + kHeader;
  }
};

/// The forces at a site of a step whose forces were solved.
struct HeldSite {
  double* p;
  std::int64_t pair() const { return static_cast<std::int64_t>(p[0]); }
  double normal_force() const { return p[1]; }           // [N]
  Vec3 force() const { return {p[2], p[3], p[4]}; }      // on A [N]
  Vec3 torque() const { return {p[5], p[6], p[7]}; }     // on A, about the centroid [N m]
  Vec3 centroid() const { return {p[8], p[9], p[10]}; }  // [m]

  void set(std::int64_t pair, const SiteReport& site) const {
    p[0] = static_cast<double>(pair);
    p[1] = site.normal_force;
    const Vec3 vectors[] = {site.force_on_A, site.torque_on_A, site.metrics.centroid};
    double* out = p + 2;
    for (const Vec3& v : vectors) out = std::copy_n(v.data(), 3, out);
  }
};

/// Energies of one evaluation.
struct EnergyAccount {
  double elastic = 0.0;       ///< stored in the contacts, with that of the bristles [J]
  ByChannel dissipated;       ///< since the start [J]
  ByChannel power;            ///< dissipated at the evaluation [W]
  ByChannel taken;            ///< dissipated, or put into bristles, at the evaluation [W]
  double slide_energy = 0.0;  ///< of the bristles [J]
  double spin_energy = 0.0;   ///< [J]
  double stored = 0.0;        ///< power into the elastic energy of the volumes, where `taken`
                              ///< has it not in it [W]
  bool implicit = false;      ///< `taken` is the mean over the step that follows, with what goes
                              ///< into elastic energy in its normal channel
  double work = 0.0;          ///< done on the scene by what was written, since the start [J]
  double numerical = 0.0;     ///< what of -work is neither stored nor dissipated: made by the
                              ///< finite step, since the start [J]
  double force_power = 0.0;   ///< of what was written, at the evaluation [W]
  double last_power = 0.0;  ///< the same of the last stage of the Runge-Kutta step that ends here,
                            ///< which the evaluation replaces [W]
  double unpaid = 0.0;      ///< what the laws hold besides `elastic`, which no motion put in [J]
  double driven = 0.0;      ///< work of mocap bodies on the contacts, since the start [J]
  double made = 0.0;  ///< by the contacts in the step that ends here: work and what is stored more,
                      ///< less what mocap bodies did and what was released [J]
  double released = 0.0;   ///< to bodies that part slowly, of what had been dissipated, since the
                           ///< start [J]
  double releasing = 0.0;  ///< in the step that follows [J]
  double friction_power = 0.0;  ///< of the friction that was written, at the evaluation [W]
  double owed = 0.0;            ///< lent by finite steps and not given back [J]
};

/// What an evaluation was for the integrator.
enum class Stage : int {
  kWhole = 0,         ///< at the begin or end of a step
  kMiddle = 1,        ///< of a Runge-Kutta step, for the first time
  kSecondMiddle = 2,  ///< for the second time; the slot has the mean power of both
};

/// What one evaluation left: its time, its energies, its forces, its law states.
class Slot {
 public:
  Slot(double* numbers, int dofs, int mocaps) : p_(numbers), dofs_(dofs), mocaps_(mocaps) {}

  double& time() const { return p_[0]; }
  double& step() const { return p_[1]; }
  double* forces() const { return p_ + UserdataLayout::kSlotHead; }
  double* friction() const { return forces() + dofs_; }
  double* mocaps() const { return friction() + dofs_; }
  double* states() const { return mocaps() + mocaps_; }

  Stage stage() const { return static_cast<Stage>(static_cast<int>(p_[2])); }
  void set_stage(Stage stage) const { p_[2] = static_cast<int>(stage); }

  EnergyAccount energy() const {
    return {p_[3],         channels(4), channels(8), channels(12), p_[16], p_[17], p_[18],
            p_[19] != 0.0, p_[20],      p_[21],      p_[22],       p_[23], p_[24], p_[25],
            p_[26],        p_[27],      p_[28],      p_[29],       p_[30]};
  }
  void set_energy(const EnergyAccount& e) const {
    p_[3] = e.elastic;
    set_channels(4, e.dissipated);
    set_channels(8, e.power);
    set_channels(12, e.taken);
    p_[16] = e.slide_energy;
    p_[17] = e.spin_energy;
    p_[18] = e.stored;
    p_[19] = e.implicit ? 1.0 : 0.0;
    p_[20] = e.work;
    p_[21] = e.numerical;
    p_[22] = e.force_power;
    p_[23] = e.last_power;
    p_[24] = e.unpaid;
    p_[25] = e.driven;
    p_[26] = e.made;
    p_[27] = e.released;
    p_[28] = e.releasing;
    p_[29] = e.friction_power;
    p_[30] = e.owed;
  }

 private:
  ByChannel channels(int i) const { return {p_[i], p_[i + 1], p_[i + 2], p_[i + 3]}; }
  void set_channels(int i, const ByChannel& c) const {
    const double numbers[] = {c.normal, c.roll, c.slide, c.spin};
    std::copy(std::begin(numbers), std::end(numbers), p_ + i);
  }

  double* p_;
  int dofs_, mocaps_;
};

/// Our block in one mjData.
class UserdataBlock {
 public:
  /// `end` is one past the last number of userdata.
  UserdataBlock(double* end, const UserdataLayout& layout)
      : layout_(layout), header_(end - UserdataLayout::kHeader) {}

  /// False until an evaluation has written it, and after a reset.
  bool is_ours() const {
    return header_[0] == kMagic && header_[1] == UserdataLayout::kVersion &&
           header_[2] == layout_.channels;
  }

  /// Makes the block ours. A change in the number of law states forgets the states and the energy
  /// account, but not the ledger.
  void claim() const {
    if (!is_ours()) {
      std::fill_n(header_ - layout_.ledger_size(), layout_.ledger_size() + UserdataLayout::kHeader,
                  0.0);
      header_[0] = kMagic;
      header_[1] = UserdataLayout::kVersion;
      header_[2] = layout_.channels;
    }
    if (header_[3] != layout_.states) {
      header_[3] = layout_.states;
      set_count(0);
    }
  }

  int count() const { return static_cast<int>(header_[4]); }
  void set_count(int count) const { header_[4] = count; }

  /// Slot `age` evaluations back, 0 for the newest; age < count().
  Slot slot(int age) const {
    const int index = (newest() + UserdataLayout::kSlots - age) % UserdataLayout::kSlots;
    return Slot(
        header_ - layout_.ledger_size() - (UserdataLayout::kSlots - index) * layout_.slot_size(),
        layout_.dofs, layout_.mocaps);
  }

  void drop_newest() const {
    header_[5] = (newest() + UserdataLayout::kSlots - 1) % UserdataLayout::kSlots;
    set_count(count() - 1);
  }
  void push() const {
    header_[5] = (newest() + 1) % UserdataLayout::kSlots;
    set_count(std::min(count() + 1, UserdataLayout::kSlots));
  }

  bool ledger_is_valid() const { return header_[6] != 0.0; }
  void set_ledger_valid() const { header_[6] = 1.0; }
  double* base() const { return header_ - layout_.ledger_size(); }
  double* left() const { return base() + layout_.channels; }

  /// How many sites the newest step solved, by pairs in ascending order, and one of them.
  int solved() const { return layout_.solved_rows > 0 ? static_cast<int>(*solved_block()) : 0; }
  void set_solved(int count) const {
    if (layout_.solved_rows > 0) *solved_block() = std::min(count, layout_.solved_rows);
  }
  HeldSite solved_site(int i) const {
    return {solved_block() + 1 + layout_.dofs +
            static_cast<std::ptrdiff_t>(i) * UserdataLayout::kSolvedRow};
  }
  /// Their generalized forces together, which a Runge-Kutta step holds; where some are solved.
  double* held() const { return solved_block() + 1; }

  /// Positions, then velocities, of the newest evaluation.
  double* motion() const { return solved_block() - layout_.motion; }

  /// Evaluations in which a force was no number and was left out.
  double& dropped() const { return header_[7]; }

  /// Evaluations in which there were more sites than rows to keep them in.
  double& forgotten() const { return header_[8]; }

 private:
  static constexpr double kMagic = 860310740.0;

  double* solved_block() const {
    return header_ - layout_.ledger_size() - UserdataLayout::kSlots * layout_.slot_size() -
           layout_.solved_size();
  }
  int newest() const { return static_cast<int>(header_[5]); }

  UserdataLayout layout_;
  double* header_;
};

/// The longest time from one evaluation to the next, in steps.
inline constexpr double kLongestGap = 1.5;

/// Opens the slot of an evaluation at `time` [s] and returns how many seconds after its predecessor
/// it lies; afterwards slot(0) is the evaluation's own and slot(1) its predecessor, if count() > 1.
///
/// Evaluations at or after `time` are forgotten: MuJoCo has gone back to redo them (Runge-Kutta
/// stages, finite differences, repeated mj_forward). After a jump in time of more than a step and a
/// half all are forgotten: somebody has set another state (see moved_clock.h where they have not).
inline double open_slot(const UserdataBlock& block, double time, double step) {
  while (block.count() > 0 && block.slot(0).time() >= time) block.drop_newest();
  double elapsed = 0.0;
  if (block.count() > 0) {
    elapsed = time - block.slot(0).time();
    if (!(elapsed <= kLongestGap * std::max(step, block.slot(0).step()))) {
      block.set_count(0);
      elapsed = 0.0;
    }
  }
  block.push();
  block.slot(0).time() = time;
  block.slot(0).step() = step;
  block.slot(0).set_stage(Stage::kWhole);
  return elapsed;
}

}  // namespace volcontact::adaptor
