// SPDX-License-Identifier: Apache-2.0

// Python module `volcontact_timing` of peers_benchmark.py and mesh_benchmark.py: our queries timed
// without Python, the independent integral they are judged by, and the bumpy balls of the tests.
// The solids are those of the package `volcontact`.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/variant.h>

#include <algorithm>
#include <ctime>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "core/reference/reference_integral.h"
#include "core/support/meshes.h"
#include "volcontact/base/simd.h"
#include "volcontact/pair/interference.h"

namespace volcontact {
namespace {

namespace nb = nanobind;

using Poses = nb::ndarray<const double, nb::shape<-1, 4, 4>, nb::c_contig, nb::device::cpu>;
using Matrix4 = nb::ndarray<const double, nb::shape<4, 4>, nb::c_contig, nb::device::cpu>;

Pose pose_from(const double* numbers) {
  const auto X = Matrix<4, 4>::from_rows(numbers);
  return {X.block<3, 3>(0, 0), X.col(3).head<3>()};
}

std::vector<Pose> poses_from(const Poses& matrices) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < matrices.shape(0); ++i) {
    poses.push_back(pose_from(matrices.data() + 16 * i));
  }
  return poses;
}

// Processor time of this thread [ns].
double thread_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e9 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec);
}

// Nanoseconds a query, over at least so many queries, all poses equally often.
double time_queries(const Shape& a, const Shape& b, const Poses& matrices, double tolerance,
                    const std::string& engine, int queries) {
  const std::vector<Pose> poses = poses_from(matrices);
  const InterferenceOptions options{tolerance, engine_from(engine), 1};
  InterferenceWorkspace workspace;
  Interference out;
  for (const Pose& X_AB : poses) interference(a, b, X_AB, options, workspace, out);  // warm
  const std::size_t rounds = 1 + static_cast<std::size_t>(queries) / poses.size();
  double keep = 0.0;
  const double begin = thread_time();
  for (std::size_t round = 0; round < rounds; ++round) {
    for (const Pose& X_AB : poses) {
      interference(a, b, X_AB, options, workspace, out);
      keep += out.total.volume;
    }
  }
  const double time = thread_time() - begin;
  if (!(keep >= 0.0)) throw std::runtime_error("time_queries: a volume is no number");
  return time / static_cast<double>(rounds * poses.size());
}

// Volume of the overlap [m^3] and its error [m^3], by an integral that shares nothing with the
// engines. They only say where to look: the values do not depend on it.
std::tuple<double, double> reference_volume(const Shape& a, const Shape& b, const Matrix4& X,
                                            double half_range) {
  const Pose X_AB = pose_from(X.data());
  InterferenceWorkspace workspace;
  Interference out;
  interference(a, b, X_AB, {}, workspace, out);
  const VolumeMetrics& m = out.total;
  const test::Reference r =
      test::reference_integral(test::reference_solid(a), test::reference_solid(b), X_AB,
                               {{basis_with_z(m.normal()), m.centroid}, half_range});
  return {r.metrics.volume, r.volume_error};
}

using Points = nb::ndarray<nb::numpy, double, nb::shape<-1, 3>, nb::c_contig>;
using Faces = nb::ndarray<nb::numpy, int, nb::shape<-1, 3>, nb::c_contig>;

// A new array of Python with a row of each.
template <typename Array, typename Number, typename Row>
Array rows_of(const std::vector<Row>& rows) {
  Number* const numbers = new Number[3 * rows.size()];
  const nb::capsule owner(numbers, [](void* p) noexcept { delete[] static_cast<Number*>(p); });
  for (std::size_t i = 0; i < rows.size(); ++i) std::copy_n(rows[i].begin(), 3, numbers + 3 * i);
  return Array(numbers, {rows.size(), 3}, owner);
}

// Points and triangles of a ball of about radius 1 with bumps, 20 * 4^levels triangles.
std::tuple<Points, Faces> bumpy_ball(int levels, int seed) {
  const test::Soup soup = test::bumpy_soup(levels, seed);
  return {rows_of<Points, double>(soup.vertices), rows_of<Faces, int>(soup.triangles)};
}

const char* simd_path() {
  constexpr const char* kNames[] = {"portable", "AVX2", "AVX-512"};
  return kNames[static_cast<int>(best_simd_path())];
}

}  // namespace

NB_MODULE(volcontact_timing, m) {
  nb::module_::import_("volcontact");
  m.def("time_queries", &time_queries, nb::arg("a"), nb::arg("b"), nb::arg("poses"), nb::kw_only(),
        nb::arg("tolerance"), nb::arg("engine"), nb::arg("queries"));
  m.def("reference_volume", &reference_volume, nb::arg("a"), nb::arg("b"), nb::arg("X_AB"),
        nb::arg("half_range"));
  m.def("bumpy_ball", &bumpy_ball, nb::arg("levels"), nb::arg("seed"));
  m.def("simd_path", &simd_path);
}

}  // namespace volcontact
