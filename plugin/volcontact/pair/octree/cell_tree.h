// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/octree/octree_scratch.h"

namespace volcontact {

/// The cells of an octree: planted on the overlap's window and divided where the doubt about the
/// volume is largest, until its bounds are within the tolerance or the budget of cells ends.
/// docs/theory.md, "Octree".
class CellTree {
 public:
  CellTree(OctreeTask& task, OctreeScratch& scratch) : task_(task), s_(scratch) {}

  /// Leaves the leaves that may hold volume in `scratch.leaves`. False when the rest is worth
  /// sharing and the team of the task is not open: then to be called again.
  bool grow();
  double high() const { return high_; }
  bool approximate() const { return approximate_; }
  /// A field was no number somewhere.
  bool invalid() const { return invalid_; }

 private:
  void plant();
  void add_region(int piece_a, int piece_b);
  void add_faces(const SolidView& view, int owner, const PieceList& list, int piece,
                 const Pose& X_SW);
  bool cut_by_planes(int first_face);
  void add_root(int first_face, const CutPolytope& hull);
  Cell& new_cell();
  bool samples_fields() const;
  void sample_fields(int first);
  void sample(int owner, int first);
  void bear(int index, const OctreeScratch::Birth& birth);
  void evaluate(int first, double rough_above);
  void take_up();
  bool precise() const;
  void smooth();
  bool divide_worst();
  bool wants_team() const;
  bool refine();
  double threshold() const;

  OctreeTask& task_;
  OctreeScratch& s_;
  double low_ = 0.0, volume_ = 0.0, high_ = 0.0;
  double settled_ = 0.0;  // volume of the leaves without doubt
  bool planted_ = false;
  bool approximate_ = false;
  bool invalid_ = false;
};

}  // namespace volcontact
