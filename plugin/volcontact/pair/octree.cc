// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/octree.h"

#ifdef _OPENMP
#include <omp.h>
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "volcontact/base/ordered_sum.h"
#include "volcontact/pair/overlap_window.h"

namespace volcontact {
namespace {

constexpr int kMostCells = 60000;   // about 25 MB and 30 ms
constexpr int kEvaluateGrain = 8;   // cells a thread takes at a time
constexpr int kSumGrain = 64;       // cells in a partial sum
constexpr int kWorthThreads = 256;  // cells in a round, when the number of threads is our choice
constexpr double kRoughShare =
    0.5;  // of that threshold: more doubt means division in the next round
constexpr double kRestShare = 0.5;    // of the tolerance, left to the cells that are not divided
constexpr double kColumnShare = 2.0;  // of the tolerance, for the volume that columns add up to
constexpr double kColumnTolerance = 1e-4;  // ... which is not asked to be finer than this
constexpr double kMostPatches = 4096;      // from which columns start
constexpr double kNudge = 1e-6;            // from the surface of a field, in sizes of the scene
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// The root box is a little larger than the hull, and not in the middle of it, so that neither its
// sides nor the halvings coincide with faces of the solids.
constexpr double kMarginLow = 0.0137, kMarginHigh = 0.0091;

int thread_index() {
#ifdef _OPENMP
  return omp_get_thread_num();
#else
  return 0;
#endif
}

int thread_limit(int asked) {
#ifdef _OPENMP
  if (omp_in_parallel()) return 1;
  return asked > 0 ? asked : omp_get_max_threads();
#else
  return (void)asked, 1;
#endif
}

// One evaluation: the tree and what is read off it.
class Octree {
 public:
  Octree(const SolidView& a, const SolidView& b, const InterferenceOptions& options,
         const OverlapWindow& window, OctreeScratch& scratch)
      : a_(a),
        b_(b),
        window_(window),
        s_(scratch),
        tolerance_(options.tolerance),
        asked_threads_(options.threads),
        thread_limit_(thread_limit(options.threads)) {
    if (static_cast<int>(s_.cutters.size()) < thread_limit_) s_.cutters.resize(thread_limit_);
  }

  void run(Interference& out) {
    plant();
    refine();
    list_leaves();
    const bool one_site = a_.convex && b_.convex;
    const int sites = one_site ? 1 : find_sites();
    for (int site = 0; site < sites; ++site) {
      const VolumeMetrics metrics = transformed(metrics_of(one_site ? -1 : site), window_.X_AW);
      if (metrics.volume > 0.0) out.sites.push_back(metrics);
    }
    if (out.sites.empty()) {
      out.total.volume_error = rounding_ + (high_ - 0.0);
      out.total.status = approximate_ ? Status::kApproximate : Status::kOk;
    } else {
      out.total = out.sites[0];
      for (std::size_t i = 1; i < out.sites.size(); ++i) out.total = out.total + out.sites[i];
    }
  }

 private:
  void plant();
  void add_region(int piece_a, int piece_b);
  void add_faces(const SolidView& view, int owner, const PieceList& list, int piece,
                 const Pose& X_SW);
  bool cut_by_seams(int first_face);
  void add_root(int first_face, const CutPolytope& hull);
  Cell& new_cell();
  void evaluate(int first, int last, double rough_above);
  void take_up(int first, int last);
  int threads_for(int count) const;
  bool precise() const;
  void smooth();
  bool divide_worst();
  void refine();
  double threshold() const;
  void divide(int index);
  void list_leaves();
  int find_sites();
  bool is_in(int leaf, int site) const { return site < 0 || s_.site_of[leaf] == site; }
  VolumeMetrics metrics_of(int site);
  bool contained(const OctreeScratch::Totals& t, const SolidView& inner, const Pose& X_IW,
                 VolumeMetrics& metrics) const;
  void add_depths(int site, const OctreeScratch::Totals& totals, VolumeMetrics& metrics);
  RayInterval chord(const SolidView& view, const Vec3& p_S, const Vec3& n_S, double side) const;
  OctreeScratch::Columns columns(const Cell& leaf, const Vec3& n, double side, int levels);
  double depth_moment(int site, const Vec3& n, double first_side, double volume);
  double farthest(int site, const Vec3& e);
  bool farthest_support(const Vec3& e, double& height) const;

  const SolidView& a_;
  const SolidView& b_;
  const OverlapWindow& window_;
  OctreeScratch& s_;
  const double tolerance_;
  const int asked_threads_;
  const int thread_limit_;
  double scale_ = 0.0;     // size of the numbers the faces are computed from [m]
  double rounding_ = 0.0;  // of a volume [m^3]
  double low_ = 0.0, volume_ = 0.0, high_ = 0.0;
  double settled_ = 0.0;  // volume of the leaves without doubt
  bool approximate_ = false;
};

// ---- the root cells
// ------------------------------------------------------------------------------

void Octree::plant() {
  s_.cell_count = 0;
  s_.faces.clear();
  s_.pieces_a.clear();
  s_.pieces_b.clear();
  if (a_.pieces) a_.pieces(a_.solid, s_.pieces_a);
  if (b_.pieces) b_.pieces(b_.solid, s_.pieces_b);
  Vec3 high = Vec3::Zero();
  for (const Vec3& p : s_.hull.points()) high = high.cwiseMax(p.cwiseAbs());
  scale_ = window_.X_AW.translation.norm() + window_.X_BW.translation.norm() + high.norm();
  rounding_ = 8.0 * kEpsilon * scale_ *
              (high.x() * high.y() + high.y() * high.z() + high.z() * high.x()) * 4.0;
  for (int i = 0; i < std::max(1, s_.pieces_a.size()); ++i) {
    for (int j = 0; j < std::max(1, s_.pieces_b.size()); ++j) add_region(i, j);
  }
}

void Octree::add_faces(const SolidView& view, int owner, const PieceList& list, int piece,
                       const Pose& X_SW) {
  if (list.size() == 0) {
    CellFace& face = s_.faces.emplace_back();
    face.owner = owner;
    face.field = &view;
    face.X_SW = X_SW;
    return;
  }
  for (const Quadric* q = list.begin(piece); q != list.end(piece); ++q) {
    CellFace& face = s_.faces.emplace_back();
    face.owner = owner;
    face.quadric = transformed(*q, X_SW);
  }
}

// A piece of A with a piece of B.
void Octree::add_region(int piece_a, int piece_b) {
  const int first_face = static_cast<int>(s_.faces.size());
  add_faces(a_, 0, s_.pieces_a, piece_a, window_.X_AW);
  add_faces(b_, 1, s_.pieces_b, piece_b, window_.X_BW);
  const bool seams = std::any_of(s_.faces.begin() + first_face, s_.faces.end(),
                                 [](const CellFace& face) { return face.quadric.seam; });
  if (!seams) return add_root(first_face, s_.hull);
  if (cut_by_seams(first_face)) add_root(first_face, s_.part);
}

bool Octree::cut_by_seams(int first_face) {
  s_.part = s_.hull;
  for (std::size_t i = first_face; i < s_.faces.size(); ++i) {
    const Quadric& face = s_.faces[i].quadric;
    if (!face.seam || face.bend != Bend::kFlat) continue;
    const auto height = [&face](const Vec3& p) { return face.linear.dot(p) + face.constant; };
    if (!s_.part.cut(height, 0, 0.0)) return false;
  }
  return true;
}

void Octree::add_root(int first_face, const CutPolytope& hull) {
  Vec3 low = Vec3::Constant(kInfinity), high = -low;
  for (const Vec3& p : hull.points()) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Vec3 extent = high - low;
  low -= kMarginLow * extent;
  high += kMarginHigh * extent;
  Cell& cell = new_cell();
  cell.center = 0.5 * (low + high);
  cell.half = 0.5 * (high - low);
  cell.first_face = first_face;
  cell.face_count = static_cast<int>(s_.faces.size()) - first_face;
  cell.listed = -1;
}

Cell& Octree::new_cell() {
  if (s_.cell_count == static_cast<int>(s_.cells.size())) s_.cells.resize(2 * s_.cells.size() + 64);
  Cell& cell = s_.cells[s_.cell_count++];
  cell.divided = false;
  return cell;
}

// ---- refinement
// ------------------------------------------------------------------------------------

int Octree::threads_for(int count) const {
  return asked_threads_ == 0 && count < kWorthThreads ? 1 : thread_limit_;
}

void Octree::evaluate(int first, int last, double rough_above) {
  const int count = last - first;
  const bool alone = asked_threads_ == 0 && count < kWorthThreads;
  for_each_task(count, alone ? 1 : thread_limit_, kEvaluateGrain, [&](int i) {
    s_.cutters[thread_index()].evaluate(s_.faces, s_.cells[first + i], rough_above);
  });
}

// New leaves: those without doubt are settled, the others pending.
void Octree::take_up(int first, int last) {
  for (int i = first; i < last; ++i) {
    const Cell& cell = s_.cells[i];
    if (cell.empty) continue;
    if (cell.high > cell.low) {
      s_.next_pending.push_back({i, cell.sums.volume, cell.low, cell.high});
    } else {
      settled_ += cell.sums.volume;
    }
  }
  s_.pending.swap(s_.next_pending);
  s_.next_pending.clear();
  low_ = volume_ = high_ = settled_;
  for (const OctreeScratch::Pending& leaf : s_.pending) {
    low_ += leaf.low;
    volume_ += leaf.volume;
    high_ += leaf.high;
  }
}

// Leaves with at least this doubt are divided; the doubts of the others add up to a share of the
// tolerance at most. By powers of two, so that one pass is enough.
double Octree::threshold() const {
  constexpr int kBins = 64;
  double largest = 0.0;
  for (const auto& leaf : s_.pending) largest = std::max(largest, leaf.high - leaf.low);
  const int top = std::ilogb(largest);
  std::array<double, kBins> bins{};
  for (const auto& leaf : s_.pending) {
    const double doubt = leaf.high - leaf.low;
    const int bin = top - std::ilogb(doubt);
    if (bin < kBins) bins[bin] += doubt;
  }
  double rest = 0.0;
  int bin = kBins - 1;
  while (bin > 0 && rest + bins[bin] <= kRestShare * tolerance_ * volume_) rest += bins[bin--];
  return std::ldexp(1.0, top - bin);
}

void Octree::divide(int index) {
  s_.cells[index].divided = true;
  const std::uint8_t split = s_.cells[index].split;
  for (int child = 0; child < 8; ++child) {
    if (child & ~split) continue;
    Cell& cell = new_cell();  // may move the parent
    const Cell& parent = s_.cells[index];
    cell.center = parent.center;
    cell.half = parent.half;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(split >> axis & 1)) continue;
      cell.half[axis] *= 0.5;
      cell.center[axis] += child >> axis & 1 ? cell.half[axis] : -cell.half[axis];
    }
    cell.first_face = parent.first_face;
    cell.face_count = parent.face_count;
    cell.listed = parent.listed;
    cell.list = parent.list;
  }
}

bool Octree::precise() const {
  return std::max(high_ - volume_, volume_ - low_) <= std::max(tolerance_ * volume_, rounding_);
}

// Works out the leaves that were left rough; their estimates take the place of the middle of their
// bounds.
void Octree::smooth() {
  const int count = static_cast<int>(s_.pending.size());
  for_each_task(count, threads_for(count), kEvaluateGrain, [&](int i) {
    OctreeScratch::Pending& leaf = s_.pending[i];
    Cell& cell = s_.cells[leaf.cell];
    if (!cell.rough) return;
    s_.cutters[thread_index()].evaluate(s_.faces, cell);
    leaf.volume = cell.sums.volume;
  });
  s_.next_pending.swap(s_.pending);
  s_.pending.clear();
  take_up(0, 0);
}

// Divides the leaves with much doubt. False when the budget of cells does not allow it.
bool Octree::divide_worst() {
  const double least = threshold();
  const int first = s_.cell_count;
  int children = 0;
  for (const auto& leaf : s_.pending) {
    if (leaf.high - leaf.low >= least) children += 1 << std::popcount(s_.cells[leaf.cell].split);
  }
  if (first + children > kMostCells) return false;
  for (const auto& leaf : s_.pending) {
    if (leaf.high - leaf.low >= least) {
      divide(leaf.cell);
    } else {
      s_.next_pending.push_back(leaf);
    }
  }
  evaluate(first, s_.cell_count, kRoughShare * least);
  take_up(first, s_.cell_count);
  return true;
}

void Octree::refine() {
  s_.pending.clear();
  s_.next_pending.clear();
  evaluate(0, s_.cell_count, 0.0);
  take_up(0, s_.cell_count);
  do {
    while (!precise() && !approximate_) approximate_ = !divide_worst();
    smooth();
  } while (!precise() && !approximate_);
  approximate_ = !precise();
}

void Octree::list_leaves() {
  s_.leaves.clear();
  for (int i = 0; i < s_.cell_count; ++i) {
    if (!s_.cells[i].divided && !s_.cells[i].empty) s_.leaves.push_back(i);
  }
}

// ---- sites
// ---------------------------------------------------------------------------------------

// Numbers the connected regions: leaves that share a part of a side belong together.
int Octree::find_sites() {
  const int count = static_cast<int>(s_.leaves.size());
  s_.site_of.resize(count);
  s_.order.resize(count);
  std::iota(s_.site_of.begin(), s_.site_of.end(), 0);
  std::iota(s_.order.begin(), s_.order.end(), 0);
  const auto cell = [this](int i) -> const Cell& { return s_.cells[s_.leaves[i]]; };
  const auto start = [&](int i) { return cell(i).center.x() - cell(i).half.x(); };
  std::sort(s_.order.begin(), s_.order.end(),
            [&](int i, int j) { return start(i) != start(j) ? start(i) < start(j) : i < j; });
  const auto root = [this](int i) {
    while (s_.site_of[i] != i) i = s_.site_of[i] = s_.site_of[s_.site_of[i]];
    return i;
  };
  const double slack = 1e-12 * scale_;
  const auto touching = [&](const Cell& p, const Cell& q) {
    const Vec3 overlap = p.half + q.half - (p.center - q.center).cwiseAbs();
    return overlap.minCoeff() >= -slack && (overlap.array() > slack).count() >= 2;
  };
  for (int k = 0; k < count; ++k) {
    const int i = s_.order[k];
    const double end = cell(i).center.x() + cell(i).half.x() + slack;
    if (!(cell(i).sums.volume > 0.0)) continue;
    for (int m = k + 1; m < count && start(s_.order[m]) <= end; ++m) {
      const int j = s_.order[m];
      if (!(cell(j).sums.volume > 0.0) || !touching(cell(i), cell(j))) continue;
      const int first = std::min(root(i), root(j)), second = std::max(root(i), root(j));
      s_.site_of[second] = first;
    }
  }
  int sites = 0;
  for (int i = 0; i < count; ++i) s_.order[i] = s_.site_of[i] == i ? sites++ : -1;
  for (int i = count - 1; i >= 0; --i) s_.site_of[i] = s_.order[root(i)];
  return sites;
}

// ---- metrics
// -------------------------------------------------------------------------------------

OctreeScratch::Totals totals_of(const Cell& cell) {
  const Vec3& c = cell.center;
  OctreeScratch::Totals t;
  t.volume = cell.sums.volume;
  t.low = cell.low;
  t.high = cell.high;
  t.first = cell.sums.first + t.volume * c;
  const Mat3 cross = c * cell.sums.first.transpose();
  t.second = cell.sums.second + cross + cross.transpose() + t.volume * c * c.transpose();
  t.surface = cell.sums.surface;
  for (CellSums::Surface& surface : t.surface) surface.moment += c.cross(surface.area_vector);
  t.doubt = cell.doubt;
  return t;
}

// The overlap is all of one solid: its own metrics are exact, and there is no direction.
bool Octree::contained(const OctreeScratch::Totals& t, const SolidView& inner, const Pose& X_IW,
                       VolumeMetrics& metrics) const {
  const double slack = 2.0 * (t.high - t.low) + rounding_ + 1e-9 * t.volume;
  if (!(inner.own.volume > 0.0 && std::abs(inner.own.volume - t.volume) <= slack)) return false;
  const VolumeMetrics own = transformed(inner.own, X_IW.inverse());
  metrics.volume = own.volume;
  metrics.centroid = own.centroid;
  metrics.inertia = own.inertia;
  metrics.area_vector = metrics.area_moment = Vec3::Zero();
  metrics.volume_error = rounding_;
  metrics.status = Status::kContained;
  return true;
}

VolumeMetrics Octree::metrics_of(int site) {
  const auto t = ordered_sum<OctreeScratch::Totals>(
      static_cast<int>(s_.leaves.size()), thread_limit_, kSumGrain, s_.partial_totals, [&](int i) {
        return is_in(i, site) ? totals_of(s_.cells[s_.leaves[i]]) : OctreeScratch::Totals{};
      });
  MomentSum moments;
  moments.volume = t.volume;
  moments.first = t.first;
  moments.second = t.second;
  // S from either body; the one whose faces are in less doubt counts more.
  const double doubt = t.doubt[0] + t.doubt[1];
  const double share = doubt > 0.0 ? t.doubt[1] / doubt : 0.5;
  moments.area_vector = share * t.surface[0].area_vector - (1.0 - share) * t.surface[1].area_vector;
  moments.area_moment = share * t.surface[0].moment - (1.0 - share) * t.surface[1].moment;
  moments.area = t.surface[0].area;
  moments.counter_area = t.surface[1].area;
  VolumeMetrics metrics = moments.metrics();
  metrics.volume_error = std::max(t.high - t.volume, t.volume - t.low) + rounding_;
  metrics.status = approximate_ ? Status::kApproximate : Status::kOk;
  if (!(metrics.volume > 0.0)) return metrics;
  if ((metrics.counter_area == 0.0 && contained(t, a_, window_.X_AW, metrics)) ||
      (metrics.area == 0.0 && contained(t, b_, window_.X_BW, metrics))) {
    return metrics;
  }
  add_depths(site, t, metrics);
  return metrics;
}

// ---- depth
// ---------------------------------------------------------------------------------------

// The part of the line p + t n within the solid, for a point p of a surface on the side `side` n.
RayInterval Octree::chord(const SolidView& view, const Vec3& p_S, const Vec3& n_S,
                          double side) const {
  if (view.ray) return view.ray(view.solid, p_S, n_S);
  // Steps of the signed distance from just below p to the far side.
  constexpr int kMostSteps = 100;
  const double nudge = kNudge * scale_;
  double way = nudge;
  for (int i = 0; i < kMostSteps; ++i) {
    const double step = -view.signed_distance(view.solid, p_S - way * side * n_S);
    if (!(step > 0.01 * nudge)) break;
    way += step;
  }
  if (!(way > nudge)) return {};
  return side > 0.0 ? RayInterval{-way, 0.0} : RayInterval{0.0, way};
}

// What the columns along n that end on the side `side` n in the leaf's surface add to the volume
// and to the depth moment.
OctreeScratch::Columns Octree::columns(const Cell& leaf, const Vec3& n, double side, int levels) {
  const Vec3 n_A = window_.X_AW.rotation * n, n_B = window_.X_BW.rotation * n;
  Cell cell = leaf;
  OctreeScratch::Columns sum;
  s_.cutters[thread_index()].for_each_surface_point(
      s_.faces, cell, side * n, levels, [&](const CellCut::SurfacePoint& point) {
        const double area = side * n.dot(point.element);
        if (!(area * point.sign > 0.0)) return;
        const Vec3 p = cell.center + point.position;
        const RayInterval in_a = chord(a_, window_.X_AW * p, n_A, side);
        const RayInterval in_b = chord(b_, window_.X_BW * p, n_B, side);
        if (in_a.empty() || in_b.empty()) return;
        const double length = std::min(in_a.leave, in_b.leave) - std::max(in_a.enter, in_b.enter);
        if (!(length > 0.0)) return;
        // Where A ends inside of B the column keeps its length under a push, and its force.
        const double pushed = in_b.leave - in_a.enter;
        const double lever = std::isfinite(pushed) ? pushed - 0.5 * length : 0.5 * length;
        sum += {area * length, area * length * lever};
      });
  return sum;
}

// int L^2/2 dA. L may have kinks where no leaf ends; the volume, known better, tells whether the
// columns saw them. Columns are followed from one side, then from the other, then more densely.
double Octree::depth_moment(int site, const Vec3& n, double first_side, double volume) {
  OctreeScratch::Columns best;
  double least_error = kInfinity;
  const double allowed = kColumnShare * std::max(tolerance_, kColumnTolerance) * volume + rounding_;
  double patches = static_cast<double>(s_.leaves.size());
  for (int levels = 0; levels == 0 || patches <= kMostPatches; ++levels, patches *= 4.0) {
    for (const double side : {first_side, -first_side}) {
      const auto sum = ordered_sum<OctreeScratch::Columns>(
          static_cast<int>(s_.leaves.size()), thread_limit_, kSumGrain, s_.partial_columns,
          [&](int i) {
            return is_in(i, site) ? columns(s_.cells[s_.leaves[i]], n, side, levels)
                                  : OctreeScratch::Columns{};
          });
      const double error = std::abs(sum.volume - volume);
      if (error < least_error) {
        least_error = error;
        best = sum;
      }
      if (error <= allowed) return best.moment;
    }
  }
  return best.moment;
}

// Height of the overlap over the origin of W along e, when a farthest point of one solid lies in
// the other.
bool Octree::farthest_support(const Vec3& e, double& height) const {
  const auto try_one = [&](const SolidView& own, const Pose& X_OW, const SolidView& other,
                           const Pose& X_PW) {
    if (!own.support) return false;
    const Vec3 p_O = own.support(own.solid, X_OW.rotation * e);
    if (!p_O.allFinite()) return false;
    const Vec3 p_W = X_OW.inverse() * p_O;
    if (other.signed_distance(other.solid, X_PW * p_W) > 1e-12 * scale_) return false;
    height = e.dot(p_W);
    return true;
  };
  return try_one(a_, window_.X_AW, b_, window_.X_BW) || try_one(b_, window_.X_BW, a_, window_.X_AW);
}

double Octree::farthest(int site, const Vec3& e) {
  double height = -kInfinity;
  if (site < 0 && farthest_support(e, height)) return height;
  CellCut& cutter = s_.cutters[0];
  for (std::size_t i = 0; i < s_.leaves.size(); ++i) {
    if (!is_in(static_cast<int>(i), site)) continue;
    Cell cell = s_.cells[s_.leaves[i]];
    if (!(cell.sums.volume > 0.0)) continue;
    const double center = e.dot(cell.center);
    if (center + e.cwiseAbs().dot(cell.half) <= height) continue;
    cutter.evaluate(s_.faces, cell);
    cutter.for_each_corner(cell.half, e, [&](const Vec3& corner) {
      height = std::max(height, center + e.dot(corner));
    });
  }
  return height;
}

void Octree::add_depths(int site, const OctreeScratch::Totals& totals, VolumeMetrics& metrics) {
  const Vec3 n = metrics.normal();
  if (n.isZero(0.0)) return;
  // First from the surface of the flatter body, whose edges are edges of the leaves' surfaces.
  const double side = totals.doubt[0] <= totals.doubt[1] ? -1.0 : 1.0;
  metrics.depth_moment = depth_moment(site, n, side, totals.volume);
  const double depth = farthest(site, n) + farthest(site, -n);
  metrics.depth = std::isfinite(depth) ? std::max(0.0, depth) : 0.0;
}

bool unbounded(const SolidView& view) { return !view.bounds.bounded(); }

}  // namespace

OctreeScratch::Totals& OctreeScratch::Totals::operator+=(const Totals& other) {
  volume += other.volume;
  low += other.low;
  high += other.high;
  first += other.first;
  second += other.second;
  for (int i = 0; i < 2; ++i) {
    surface[i].area_vector += other.surface[i].area_vector;
    surface[i].moment += other.surface[i].moment;
    surface[i].area += other.surface[i].area;
    doubt[i] += other.doubt[i];
  }
  return *this;
}

void octree_interference(const SolidView& a, const SolidView& b, const Pose& X_AB,
                         const InterferenceOptions& options, OctreeScratch& scratch,
                         Interference& out) noexcept {
  out.total = VolumeMetrics{};
  out.sites.clear();
  out.engine = Engine::kOctree;
  if (!X_AB.is_finite()) {
    out.total.status = Status::kInvalid;
    return;
  }
  if (unbounded(a) && unbounded(b)) {
    out.total.status = Status::kUnbounded;
    return;
  }
  if (a.own.volume == 0.0 || b.own.volume == 0.0) return;
  const OverlapWindow window = find_window(a, b, X_AB, scratch.hull, scratch.part);
  if (!window.apart) Octree(a, b, options, window, scratch).run(out);
}

void octree_interference(const Shape& a, const Shape& b, const Pose& X_AB,
                         const InterferenceOptions& options, OctreeScratch& scratch,
                         Interference& out) noexcept {
  octree_interference(view_of(a), view_of(b), X_AB, options, scratch, out);
}

}  // namespace volcontact
