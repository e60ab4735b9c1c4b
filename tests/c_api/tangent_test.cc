// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>

#include "c_api/support.h"

namespace volcontact::c_api::testing::tangent_test {
namespace {

using Mat12 = Eigen::Matrix<double, 12, 12, Eigen::RowMajor>;
using Mat3 = Eigen::Matrix3d;
using Vec3 = Eigen::Vector3d;
using Column12 = Eigen::Matrix<double, 12, 1>;

Column12 wrenches(const vc_result& r) {
  Column12 w;
  for (int i = 0; i < 3; ++i) {
    w[i] = r.torque_on_a[i], w[3 + i] = r.force_on_a[i];
    w[6 + i] = r.torque_on_b[i], w[9 + i] = r.force_on_b[i];
  }
  return w;
}

Column12 evaluate(const Model& model, const vc_motion& motion) {
  vc_result result;
  EXPECT_EQ(vc_evaluate(model.get(), workspace().get(), &motion, nullptr, nullptr, 0, 0.0, &result),
            0)
      << vc_error();
  return wrenches(result);
}

// Column `i` of a motion: a turn or displacement of a body, or a change of its speed.
vc_motion moved(vc_motion motion, int i, double by, bool speed) {
  if (speed) {
    // A pointer: GCC 12 with -fsanitize=bounds indexes a conditional array wrongly.
    double* velocity = i < 6 ? motion.V_WA : motion.V_WB;
    velocity[i % 6] += by;
    return motion;
  }
  double* pose = i < 6 ? motion.X_WA : motion.X_WB;
  Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> X(pose);
  if (i % 6 >= 3) {
    X(i % 6 - 3, 3) += by;
  } else {
    const Mat3 turned =
        Eigen::AngleAxisd(by, Vec3::Unit(i % 6)).toRotationMatrix() * X.topLeftCorner<3, 3>();
    X.topLeftCorner<3, 3>() = turned;
  }
  return motion;
}

Mat12 differences(const Model& model, const vc_motion& motion, bool speed, double by) {
  Mat12 out;
  for (int i = 0; i < 12; ++i) {
    out.col(i) = (evaluate(model, moved(motion, i, by, speed)) -
                  evaluate(model, moved(motion, i, -by, speed))) /
                 (2.0 * by);
  }
  return out;
}

vc_tangent tangent_of(const Model& model, const vc_motion& motion) {
  const Workspace scratch = workspace();
  vc_result result;
  vc_tangent tangent;
  EXPECT_EQ(vc_evaluate(model.get(), scratch.get(), &motion, nullptr, nullptr, 0, 0.0, &result), 0);
  EXPECT_EQ(vc_tangent_of(model.get(), scratch.get(), &tangent), 0) << vc_error();
  return tangent;
}

// Largest error against the largest entry, torques and turns brought to forces and ways by the size
// of the box.
double worst(Mat12 got, Mat12 wanted) {
  constexpr double kSize = 0.1;  // [m]
  for (Mat12* m : {&got, &wanted}) {
    for (int i = 0; i < 12; ++i) {
      if (i % 6 < 3) m->row(i) /= kSize, m->col(i) /= kSize;
    }
  }
  return (got - wanted).cwiseAbs().maxCoeff() / wanted.cwiseAbs().maxCoeff();
}

Model with_laws(Model model) {
  EXPECT_EQ(set(model, "stiffness", 1e8), 0);
  EXPECT_EQ(set(model, "damping", 0.5), 0);
  EXPECT_EQ(set(model, "tolerance", 1e-9), 0);
  EXPECT_EQ(vc_model_choose(model.get(), "friction_law", "regularized_coulomb"), 0);
  EXPECT_EQ(set(model, "slip_speed", 0.05), 0);
  return model;
}

vc_motion moving(vc_motion motion) {
  const double A[] = {0.2, -0.1, 0.3, 0.02, 0.01, -0.03}, B[] = {-0.1, 0.2, 0.1, 0.01, 0.0, 0.02};
  std::copy_n(A, 6, motion.V_WA);
  std::copy_n(B, 6, motion.V_WB);
  return motion;
}

TEST(CTangent, BoxOnAPlaneIsThatOfDifferences) {
  const Model model =
      with_laws(model_of(solid("box", "half_sizes", {0.1, 0.08, 0.05}), solid("half_space")));
  const vc_motion motion = moving(at(0.3, -0.2, 0.049, 0.4));
  const vc_tangent tangent = tangent_of(model, motion);
  EXPECT_LT(
      worst(Eigen::Map<const Mat12>(tangent.by_speed), differences(model, motion, true, 1e-6)),
      1e-5);
  EXPECT_LT(
      worst(Eigen::Map<const Mat12>(tangent.by_motion), differences(model, motion, false, 1e-7)),
      0.05);
}

TEST(CTangent, BallOnAPlaneIsThatOfDifferences) {
  const Model model = with_laws(model_of(solid("sphere", "radius", {0.05}), solid("half_space")));
  const vc_motion motion = moving(at(0.3, -0.2, 0.049));
  const vc_tangent tangent = tangent_of(model, motion);
  EXPECT_LT(
      worst(Eigen::Map<const Mat12>(tangent.by_speed), differences(model, motion, true, 1e-6)),
      1e-5);
  // By the displacement of A; by its turn the arm to the centroid is all there is.
  const auto of = [](const Mat12& m) { return Eigen::Matrix<double, 6, 3>(m.block<6, 3>(0, 3)); };
  const auto got = of(Eigen::Map<const Mat12>(tangent.by_motion));
  const auto wanted = of(differences(model, motion, false, 1e-7));
  EXPECT_LT((got - wanted).cwiseAbs().maxCoeff(), 0.02 * wanted.cwiseAbs().maxCoeff());
}

TEST(CTangent, TurnedAndMovedTogetherTheWrenchesTurnAndMoveAlong) {
  const Model model =
      with_laws(model_of(solid("box", "half_sizes", {0.1, 0.08, 0.05}), solid("half_space")));
  const vc_motion motion = at(0.3, -0.2, 0.049, 0.4);
  const vc_tangent tangent = tangent_of(model, motion);
  const Mat12 by_motion = Eigen::Map<const Mat12>(tangent.by_motion);
  const Column12 w = evaluate(model, motion);
  const Vec3 way(0.3, -0.2, 0.049);
  for (int i = 0; i < 3; ++i) {
    Column12 turn = Column12::Zero(), along = Column12::Zero(), wanted;
    turn.segment<3>(0) = turn.segment<3>(6) = Vec3::Unit(i);
    turn.segment<3>(3) = Vec3::Unit(i).cross(way);
    along.segment<3>(3) = along.segment<3>(9) = Vec3::Unit(i);
    for (int k = 0; k < 12; k += 3) wanted.segment<3>(k) = Vec3::Unit(i).cross(w.segment<3>(k));
    EXPECT_LT((by_motion * turn - wanted).norm(), 1e-6 * by_motion.norm());
    EXPECT_LT((by_motion * along).norm(), 1e-9 * by_motion.norm());
  }
}

TEST(CTangent, WantsAnEvaluationOfTheModelAsItIs) {
  const Model model = with_laws(model_of(solid("sphere", "radius", {0.05}), solid("half_space")));
  const Workspace scratch = workspace();
  vc_tangent tangent;
  EXPECT_TRUE(fails(vc_tangent_of(model.get(), scratch.get(), &tangent), VC_ERROR_ARGUMENT,
                    {"vc_evaluate first"}));
}

// A block that sticks, then slides: the states that a solver integrates by the rates are those that
// the law integrates itself.
TEST(CRates, IntegratedTheyAreTheStatesOfTheLaw) {
  Model model = model_of(solid("box", "half_sizes", {0.1, 0.1, 0.05}), solid("half_space"));
  ASSERT_EQ(set(model, "stiffness", 1e7), 0);
  ASSERT_EQ(vc_model_choose(model.get(), "friction_law", "bristle"), 0);
  const auto size = static_cast<std::size_t>(vc_model_state_size(model.get(), 2));
  const Workspace scratch = workspace();
  const auto motion_at = [](double t) {
    vc_motion motion = at(2e-3 * t, 0.0, 0.049);
    motion.V_WA[3] = 2e-3;
    return motion;
  };
  vc_result law, rated;
  std::vector<double> state(size), next(size), mine(size), rates(size);
  const int n = static_cast<int>(size);
  vc_motion motion = motion_at(0.0);
  ASSERT_EQ(vc_evaluate(model.get(), scratch.get(), &motion, nullptr, state.data(), n, 0.0, &law),
            0);
  mine = state;
  const double h = 1e-4;
  for (int i = 0; i < 400; ++i) {
    // The midpoint rule, with states of now.
    for (const double part : {0.5, 1.0}) {
      std::vector<double> trial = mine;
      if (part == 1.0) {
        for (std::size_t k = 0; k < size; ++k) trial[k] += 0.5 * h * rates[k];
      }
      motion = motion_at(h * (i + 0.5 * (part == 1.0)));
      ASSERT_EQ(vc_evaluate_rates(model.get(), scratch.get(), &motion, trial.data(), next.data(),
                                  rates.data(), n, &rated),
                0)
          << vc_error();
    }
    for (std::size_t k = 0; k < size; ++k) mine[k] += h * rates[k];
    motion = motion_at(h * (i + 1));
    ASSERT_EQ(
        vc_evaluate(model.get(), scratch.get(), &motion, state.data(), state.data(), n, h, &law),
        0);
  }
  ASSERT_EQ(vc_evaluate_rates(model.get(), scratch.get(), &motion, mine.data(), next.data(),
                              rates.data(), n, &rated),
            0);
  EXPECT_GT(-law.force_on_a[0], 10.0);
  EXPECT_NEAR(rated.force_on_a[0], law.force_on_a[0], 2e-3 * std::abs(law.force_on_a[0]));
  EXPECT_NEAR(rated.elastic_energy, law.elastic_energy, 1e-3 * law.elastic_energy);
}

TEST(CLayout, RecordsOfAnotherSizeAreRefused) {
  EXPECT_EQ(VC_CHECK(), 0);
  EXPECT_TRUE(fails(vc_check_layout(VC_VERSION, sizeof(vc_motion), sizeof(vc_site) - 8,
                                    sizeof(vc_result), sizeof(vc_tangent)),
                    VC_ERROR_VERSION, {"vc_site", "volcontact.h"}));
}

}  // namespace
}  // namespace volcontact::c_api::testing::tangent_test
