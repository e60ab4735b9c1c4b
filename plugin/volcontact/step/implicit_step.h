// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "volcontact/base/sizes.h"
#include "volcontact/model/site_laws.h"
#include "volcontact/step/contact_equations.h"
#include "volcontact/step/work_limit.h"

namespace volcontact {

/// What a step makes implicit.
enum class ImplicitParts : int {
  kStiff = 0,  ///< directions in which the patch is too stiff for an explicit step
  kAll = 1,
  kHeld = 2,  ///< all, of forces that are held through the stages of a Runge-Kutta step
};

/// Power that goes into the elastic energy of the volumes of a report that keeps its inputs [W].
inline double stored_power(const ContactReport& report) {
  double power = 0.0;
  for (std::size_t i = 0; i < report.inputs.size(); ++i) {
    power += report.inputs[i].normal_out.elastic * report.sites[i].approach_speed;
  }
  return power;
}

/// One step of the contact forces that is implicit in them, to first order: docs/theory.md,
/// "Implicit step". For each site f = e - C u', with u' the relative motion at the end of the step;
/// all sites of an island at once, none pulling, friction within what the solved normal force
/// holds. An island without a stiff site keeps its explicit forces. Memory is reused from step to
/// step.
class ImplicitStep {
 public:
  void clear();

  /// The sites that follow are of another pair of geoms, whose work is limited.
  void begin_pair(const WorkLimit& limit) { limits_.push_back(limit); }

  /// A site of the last pair. The report keeps its inputs. `driven`: of a against b, the motion at
  /// the site that no degree of freedom makes. `is_stiff`: an explicit step could not hold it.
  void add(const ContactModel& model, ContactReport& report, std::size_t site, int body_a,
           int body_b, const Twist& driven, bool is_stiff);

  bool empty() const { return sites_.empty(); }

  /// Of the pair that began as number i: whether its forces were solved, and the work they do over
  /// the step.
  bool is_pair_solved(std::size_t i) const { return limits_[i].is_solved; }
  double work(std::size_t i) const { return limits_[i].work(); }
  double friction_work(std::size_t i) const { return limits_[i].friction_work; }
  double released_at_most(std::size_t i) const { return limits_[i].released_at_most(); }
  double lent(std::size_t i) const { return limits_[i].lent(); }

  /// Solves, with the known forces of contact_space.h, and puts the results into the reports: the
  /// forces, and as `taken` the power that the contact takes from the motion over the step.
  /// `constraints`: what the solver of the native constraints will do in the step.
  void solve(const Mechanism& mechanism, LinearConstraints& constraints, ImplicitParts parts,
             const double* known);

  // For tests: the linear model of site i, f = e - C u', as last solved, and the solution.
  ContactSpace::Block constant(std::size_t site) const;
  ContactSpace::Square slope(std::size_t site) const;
  const ContactSpace::Block& force(std::size_t site) const { return sites_[site].force; }
  bool is_solved(std::size_t site) const { return sites_[site].is_solved; }

 private:
  // A patch is borne at up to four points, which have its area and moments; none of them pulls.
  struct Point {
    Vec3 motion = Vec3::Zero();  // of the point along n, by the normal coordinates: (1, y, -x)
    double constant = 0.0;       // f = constant - slope * speed
    double full = 0.0;           // the constant without a limit
    double slope = 0.0;
    bool pushes = true;
  };
  struct Site {
    Site(const SiteLaws& of_site, ContactReport* of_pair, std::size_t i)
        : laws(of_site), report(of_pair), index(i), tangent(of_site.tangent()) {}

    SiteLaws laws;
    ContactReport* report;
    std::size_t index;
    SiteTangent tangent;
    std::array<Point, 4> points{};
    int point_count = 0;
    Mat3 rolls = Mat3::Zero();  // the damping of turns about axes along which there is one point
    std::size_t pair = 0;
    bool is_stiff = false;
    bool is_solved = false;
    ContactSpace::Block force = ContactSpace::Block::Zero();

    bool pushes() const {
      return std::any_of(points.begin(), points.begin() + point_count,
                         [](const Point& point) { return point.pushes; });
    }
    // C of the points that push, and of friction.
    Mat3 normal_slope() const {
      Mat3 out = rolls;
      for (int k = 0; k < point_count; ++k) {
        const Point& point = points[size(k)];
        if (point.pushes) out += outer(point.slope * point.motion, point.motion);
      }
      return out;
    }
    Vec3 friction_slope() const {
      const double lever = tangent.friction.lever;
      return std::max(0.0, rub) * Vec3(1.0, 1.0, lever * lever);
    }
    // Friction: force = held - rub * slip, or `rub` alone where it slides; as (t_1, t_2, about n).
    Vec3 held = Vec3::Zero();
    double rub = 0.0;
    double strain = 0.0;      // square of what friction would have to hold, of that of what it can
    double held_share = 1.0;  // what it can hold of what it was solved to
    double free_speed = 0.0;  // slip at the end of the step without friction, and what presses then
    double free_normal = 0.0;
    // What the way over the step has, per step, beyond the slip at its end: bodies go on along
    // lines where what they lie on turns.
    Vec3 drift = Vec3::Zero();
  };
  // How friction is brought within what it can hold: cut after the solution, which is quick, or
  // solved again as a damper, which can only dissipate.
  enum class FrictionBound { kCut, kDamped };

  Site& site(std::size_t i) { return sites_[static_cast<std::size_t>(island_[i])]; }
  const Site& site(std::size_t i) const { return sites_[static_cast<std::size_t>(island_[i])]; }
  void solve_island(ImplicitParts parts, double step, double resting);
  void solve_contacts(FrictionBound bound, double step);
  void solve_with_friction(FrictionBound bound, double step);
  void limit_work(double step, double resting);
  void add_up_work(double step, double resting);
  void set_shares();
  void share_deficit();
  // The pairs that have sites in the island; these stand together.
  template <typename Use>
  void for_each_pair(Use use) {
    const WorkLimit* last = nullptr;
    for (const int i : island_) {
      WorkLimit& limit = limits_[sites_[size(i)].pair];
      if (&limit != last) use(limit);
      last = &limit;
    }
  }
  void solve_with_constraints(const Mechanism& mechanism, LinearConstraints& constraints,
                              ImplicitParts parts, int island, const double* known);
  void settle(LinearConstraints& constraints);
  void bound_unsettled(LinearConstraints& constraints, double step, double resting);
  void take_explicit();
  void write_explicit();
  void make_points(ImplicitParts parts, double step, double resting);
  void place_points(Site& site, const Mat3& mobility, const Vec3& falling, double resting,
                    ImplicitParts parts, double step);
  double normal_force(std::size_t i) const { return std::max(0.0, force_[6 * i]); }
  void solve_active(bool with_friction, double step);
  bool improve_active(bool with_friction, bool takes_back, double step);
  void solve_once(bool with_friction, double step);
  void set_drift(const Mechanism& mechanism, double time);
  bool solve_at_rest(double step);
  bool set_friction(double step);
  void set_friction_of(Site& site, std::size_t i, double step);
  void set_damper(Site& site, double normal_force, const Vec3& along, double spin,
                  double speed) const;
  void bound_friction();
  void damp_friction(double step);
  struct Load {
    double strength = 0.0, viscous = 0.0;  // of the friction law
    double most = 0.0, borne = 0.0;        // at the slip of the last solution

    double share() const { return borne > most ? most / borne : 1.0; }
  };
  Load load(std::size_t i) const;
  struct Slide {
    double force = 0.0, speed = 0.0;  // not above 0 where it stops
  };
  Slide slide_under(std::size_t i, double strength, double viscous, double step) const;
  bool is_settled() const;
  void write_results();
  ByChannel taken(const Site& site, std::size_t i) const;
  ContactSpace::Block mean_motion(std::size_t i) const;

  Vec3 slip_of(const Site& site, const std::vector<double>& u, std::size_t i) const;

  std::vector<Site> sites_;
  std::vector<WorkLimit> limits_;  // by pair
  std::vector<ContactPlace> places_;
  ContactIslands islands_;
  std::vector<double> acceleration_;
  double mass_ = 0.0;            // of the island at hand [kg]
  std::span<const int> island_;  // the sites of the one at hand; what follows is of these
  ContactSpace space_;
  ContactEquations equations_;
  std::vector<double> force_, velocity_;  // f and u'
  std::vector<double> before_;            // f of the pass before
};

}  // namespace volcontact
