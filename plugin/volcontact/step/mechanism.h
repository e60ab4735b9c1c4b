// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "volcontact/base/sizes.h"
#include "volcontact/base/types.h"

namespace volcontact {

/// A kinematic tree: its degrees of freedom, which stand together.
struct DofRange {
  int begin = 0;
  int end = 0;

  int size() const { return end - begin; }
};

/// How the bodies of a scene hang on degrees of freedom, which no step changes.
struct MechanismTrees {
  static constexpr int kNone = -1;

  std::vector<DofRange> trees;
  std::vector<double> mass;       ///< of each tree [kg]
  std::vector<int> root;          ///< of each tree, the body that carries the others
  std::vector<int> carrier;       ///< of each degree of freedom the next that carries it, or kNone
  std::vector<int> depth;         ///< of each degree of freedom: how many carry it
  std::vector<int> tree_of_dof;   ///< of each degree of freedom
  std::vector<int> last_dof;      ///< of each body, that which no other of its own carries
  std::vector<int> tree_of_body;  ///< kNone of a body that stands

  int dofs() const { return static_cast<int>(carrier.size()); }
};

/// One number of a matrix over the degrees of freedom.
struct DofEntry {
  int row;
  int column;
  double value;
};

/// The bodies at the begin of a step, as whoever steps them knows them: numbers that stay where
/// they are during the step. A body's motion is the sum of what each degree of freedom that carries
/// it gives it. Motions are of the world, six numbers: angular, and linear at the origin of the
/// tree.
class Mechanism {
 public:
  virtual ~Mechanism() = default;

  const MechanismTrees* trees = nullptr;
  double step = 0.0;                     ///< [s]
  double fall = 0.0;                     ///< by which gravity changes speeds in the step [m/s]
  const double* speeds = nullptr;        ///< of each degree of freedom
  const double* motions = nullptr;       ///< that each gives at a speed of 1
  const double* motion_rates = nullptr;  ///< by which these change [1/s]
  const double* origins = nullptr;       ///< three numbers a body; that of a root is its tree's [m]
  const double* twists = nullptr;        ///< motion of each body

  Vec3 origin(int tree) const { return numbers(origins, trees->root[size(tree)]); }
  static Vec3 angular(const double* of, int i) { return numbers(of, 2 * i); }
  static Vec3 linear(const double* of, int i) { return numbers(of, 2 * i + 1); }

  /// Of the mass matrix M what a degree of freedom has with itself, with what carries it, with what
  /// carries that, and so on, one after another. `row` has zeros.
  virtual void mass(int dof, double* row) const = 0;
  /// Appends, of any column, what the integrator adds to M for the forces by velocities that it
  /// takes implicitly. Of two numbers at one place the last counts.
  virtual void damping(std::span<const int> dofs, std::vector<DofEntry>& out) const = 0;
  /// Whether the solver of native constraints divides by what the integrator divides by, not by M.
  virtual bool constraints_see_damping() const = 0;

 private:
  static Vec3 numbers(const double* of, int i) { return Vec3::from(of + 3 * i); }
};

/// The acceleration of the point of a body while all degrees of freedom keep their speeds.
Vec3 turning_acceleration(const Mechanism& mechanism, int body, const Vec3& point);

}  // namespace volcontact
