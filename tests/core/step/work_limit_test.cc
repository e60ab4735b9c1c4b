// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/work_limit.h"

#include <gtest/gtest.h>

#include <cmath>

namespace volcontact::work_limit_test {
namespace {

PairEnergy::Now now(double elastic, double force = 0.0, double approach = 0.0) {
  PairEnergy::Now out;
  out.elastic = elastic;
  out.force = force;
  out.power = force * approach;
  return out;
}

TEST(PairEnergy, KeepsWhatWentInButNoMoreThanTheLawHolds) {
  PairEnergy energy;
  energy.solve(-5.0);
  EXPECT_EQ(energy.stored, 5.0);
  energy.take_in(1e-3, now(3.0));
  EXPECT_EQ(energy.stored, 3.0);
  EXPECT_EQ(energy.most, 3.0);  // what was lost does not measure what may be overdrawn
}

// h f (v + v')/2.
TEST(PairEnergy, ExplicitStepPutsInForceTimesMeanApproach) {
  PairEnergy energy;
  energy.force = 100.0;
  energy.power = 100.0 * 0.4;
  energy.take_in(1e-3, now(1.0, 50.0, 0.2));
  EXPECT_NEAR(energy.stored, 1e-3 * 100.0 * 0.3, 1e-15);
}

TEST(PairEnergy, BodyWithinAnotherLosesNothing) {
  PairEnergy energy;
  energy.solve(-5.0);
  PairEnergy::Now inside = now(0.0);
  inside.is_within = true;
  energy.take_in(1e-3, inside);
  EXPECT_EQ(energy.stored, 5.0);
}

TEST(PairEnergy, SlowExitDrawsOnWhatWasFound) {
  PairEnergy energy;
  energy.found = 1.0;
  energy.solve(1.5);
  EXPECT_EQ(energy.stored, 0.0);
  EXPECT_EQ(energy.found, 0.0);
}

// Each pays a share of what it holds, what was found included, and never more than that.
TEST(PairEnergy, PaysFromWhatItHolds) {
  PairEnergy energy;
  energy.stored = 3.0;
  energy.found = 1.0;
  EXPECT_EQ(energy.payable(), 4.0);
  energy.pay(0.25);
  EXPECT_NEAR(energy.stored, 2.25, 1e-15);
  EXPECT_NEAR(energy.found, 0.75, 1e-15);
  energy.pay(1.0);
  EXPECT_EQ(energy.payable(), 0.0);
  energy.stored = -0.5;
  energy.pay(1.0);
  EXPECT_EQ(energy.stored, -0.5);  // a debt pays nothing
}

// What force and approach can have put in is beyond doubt.
TEST(PairEnergy, OnlyWhatMotionDoesNotExplainIsDoubtful) {
  PairEnergy energy;
  energy.force = 100.0;
  energy.power = 100.0 * 0.5;
  energy.follow(1e-3, now(0.05, 100.0, 0.5));
  EXPECT_EQ(energy.stored, 0.05);
  EXPECT_EQ(energy.payable(), 0.0);
  energy.follow(1e-3, now(0.25, 100.0, 0.5));
  EXPECT_NEAR(energy.payable(), 0.25 - 0.05 - 1.5 * 0.05, 1e-15);
}

// A step by the law gives back as much as the law holds less, and no more: what no motion had put
// in stays unpaid, and so does what was paid for other things.
TEST(PairEnergy, WhatWasUnpaidStaysSo) {
  PairEnergy energy;
  energy.stored = energy.most = 0.8;
  energy.act(now(1.0, 100.0, -0.4));
  EXPECT_TRUE(energy.explains(1e-3, now(0.99, 99.0, -0.4)));  // nothing new came in
  energy.follow(1e-3, now(0.7, 70.0, -0.5));
  EXPECT_NEAR(energy.stored, 0.5, 1e-15);
  energy.act(now(0.7, 70.0, -0.5));
  energy.pay(0.0);
  energy.doubtful = HUGE_VAL;
  energy.pay(0.2);
  EXPECT_NEAR(energy.stored, 0.4, 1e-15);
  energy.follow(1e-3, now(0.6, 60.0, -0.5));
  EXPECT_NEAR(energy.stored, 0.3, 1e-15);
}

// What was dissipated pays for what is given in this step beyond what is lent.
TEST(PairEnergy, SlowExitReleasesBeforeItOwes) {
  PairEnergy energy;
  energy.stored = energy.most = 1.0;
  energy.solve(1.25, 0.0, 0.5, 0.125);
  EXPECT_EQ(energy.stored, -0.125);
  EXPECT_EQ(energy.released, 0.125);
  energy.stored = -0.5;
  energy.released = 0.0;
  energy.solve(0.125, 0.0, 0.5);
  EXPECT_EQ(energy.released, 0.125);
}

// A body that hovers deep in another, where nobody put anything in, would be lifted in every step
// by half of what it falls in it.
TEST(PairEnergy, WhatIsLentIsLentOnce) {
  PairEnergy energy;
  double given = 0.0;
  for (int step = 0; step < 100; ++step) {
    WorkLimit limit = WorkLimit::of(energy, 0.0, 0.1);
    limit.lend(0.3, 2.0, 0.01, 0.0);  // more than the weight
    EXPECT_EQ(limit.slack, 0.5 * 2.0 * 0.01 * 0.01);
    energy.solve(limit.allowed(), 0.0, 0.0, limit.lent());
    given += limit.allowed();
    energy.solve(0.0);  // does not push: nothing is lent, and what was stays owed
    energy.take_in(1e-3, now(100.0));
  }
  EXPECT_NEAR(given, 1e-4, 1e-15);
}

TEST(WorkLimit, IsNearlyKeptWhereWorkHangsOnRounding) {
  WorkLimit limit;
  limit.stored = 1e-9;
  limit.normal_work = 1e-6;
  EXPECT_FALSE(limit.is_kept());
  EXPECT_FALSE(limit.is_kept_nearly());
  limit.from_free = -0.05;
  EXPECT_TRUE(limit.is_kept_nearly());
}

// An explicit step may give back more than there was by what it errs by; it is owed.
TEST(PairEnergy, ExplicitStepOwesWhatItGaveTooMuch) {
  PairEnergy energy;
  energy.stored = energy.most = 1.0;
  energy.force = 1e3;
  energy.power = -1e3;
  energy.take_in(1.02e-3, now(0.0, 1.0, -1.0));
  EXPECT_NEAR(energy.stored, -0.02, 1e-12);
}

// Else a pair that parts slowly makes the rounding of every step into motion.
TEST(PairEnergy, SolvedStepOverdrawsOnceOnly) {
  PairEnergy energy;
  energy.solve(-1.0);
  energy.take_in(1e-3, now(2.0));
  double given = 0.0;
  for (int step = 0; step < 100; ++step) {
    const double work = WorkLimit::of(energy, 0.0, 0.1).allowed();
    energy.solve(work, 0.0, 0.0, WorkLimit::of(energy, 0.0, 0.1).lent());
    given += work;
  }
  EXPECT_NEAR(given, 1.0 + PairEnergy::kOverdraft, 1e-12);
}

TEST(PairEnergy, RowsAreWhatTheyWere) {
  PairEnergy energy;
  energy.stored = 1.0;
  energy.found = 2.0;
  energy.most = 4.0;
  energy.rubbed = 4.5;
  energy.force = 5.0;
  energy.power = 6.0;
  energy.unpaid = 7.0;
  double row[PairEnergy::kNumbers], again[PairEnergy::kNumbers];
  energy.write(row);
  PairEnergy::from(row).write(again);
  for (int i = 0; i < PairEnergy::kNumbers; ++i) EXPECT_EQ(row[i], again[i]) << i;
}

// What bristles give back, sliding has put in; and no more than they hold.
TEST(PairEnergy, BristlesGiveBackWhatSlidingPutIn) {
  PairEnergy energy;
  energy.solve(0.0, -2.0);
  EXPECT_EQ(energy.rubbed, 2.0);
  PairEnergy::Now held = now(0.0);
  held.bristle = 1.5;
  energy.take_in(1e-3, held);
  EXPECT_EQ(energy.rubbed, 1.5);
  WorkLimit limit = WorkLimit::of(energy, 0.0, 0.1);
  limit.friction_work = 1.4;
  EXPECT_TRUE(limit.is_kept());
  limit.friction_work = 1.6;
  EXPECT_FALSE(limit.is_kept());
}

// Work of the share s: a s + b s^2, as of one site.
double share_found(WorkLimit limit, double a, double b) {
  limit.start();
  for (int i = 0; i < 40; ++i) {
    limit.normal_work = a * limit.share + b * limit.share * limit.share;
    limit.pushes = true;
    if (!limit.search()) break;
  }
  return limit.share;
}

TEST(WorkLimit, IsNotInTheWayOfWhatIsWithin) {
  WorkLimit limit;
  limit.stored = 2.0;
  EXPECT_EQ(share_found(limit, 1.0, 1.0), 1.0);
}

TEST(WorkLimit, FindsAShareThatGivesBackMostOfWhatThereIs) {
  for (const double stored : {1e-3, 0.1, 0.9, 5.0}) {
    for (const double linear : {0.0, 1.0, 100.0}) {
      WorkLimit limit;
      limit.stored = stored;
      const double share = share_found(limit, linear, 10.0);
      const double work = linear * share + 10.0 * share * share;
      EXPECT_LE(work, stored);
      if (stored > 1e-3 * (linear + 10.0)) {
        EXPECT_GT(work, 0.5 * stored) << stored << " " << linear;
      }
    }
  }
}

TEST(WorkLimit, WithNothingStoredNothingComesBack) {
  EXPECT_EQ(share_found(WorkLimit(), 1.0, 1.0), 0.0);
}

TEST(WorkLimit, FrictionThatDissipatesPaysForNothing) {
  WorkLimit limit;
  limit.stored = 1.0;
  limit.normal_work = 1.5;
  limit.friction_work = -10.0;
  EXPECT_FALSE(limit.is_kept());
  limit.normal_work = 0.5;
  limit.friction_work = 0.7;
  EXPECT_FALSE(limit.is_kept());
}

// A body of mass m that parts at v and is pushed by s f for h: h s f (v + h s f/(2 m)) = T.
TEST(ExplicitShare, GivesBackWhatIsStored) {
  constexpr double kForce = 300.0, kParting = 0.5, kMass = 2.0, kStep = 1e-2;
  WorkLimit limit;
  limit.stored = 0.6;
  const double share = explicit_share(limit, kForce, kParting, 1.0 / kMass, kStep);
  const double impulse = kStep * share * kForce;
  EXPECT_NEAR(impulse * (kParting + 0.5 * impulse / kMass), limit.stored, 1e-12);
  limit.stored = 1e3;
  EXPECT_EQ(explicit_share(limit, kForce, kParting, 1.0 / kMass, kStep), 1.0);
}

TEST(ExplicitShare, ApproachIsNotHindered) {
  EXPECT_EQ(explicit_share(WorkLimit(), 300.0, -2.0, 0.5, 1e-3), 1.0);
}

TEST(ExplicitShare, WhatWasFoundComesOutSlowly) {
  WorkLimit limit;
  limit.slow = 1e6;
  limit.exit_speed = 0.1;
  const double share = explicit_share(limit, 1e5, 0.0, 0.5, 1e-3);
  EXPECT_NEAR(1e-3 * share * 1e5 * 0.5, 0.1, 1e-12);
  EXPECT_EQ(explicit_share(limit, 1e5, 0.2, 0.5, 1e-3), 0.0);
}

// Power laws of the depth, undamped and at constant speed, that end within the step: the work of
// the stages against what is stored.
TEST(EndExcess, IsWhatTheStagesDoTooMuch) {
  constexpr double kStep = 2e-3, kSpeed = 1.5, kRate = 1e6;
  double worst = 0.0;
  for (const double power : {1.0, 2.0, 3.0}) {
    for (double depth = 1e-4; depth < kStep * kSpeed; depth += 1e-4) {
      const auto force = [&](double x) { return kRate * std::pow(std::max(0.0, x), power); };
      const double energy = depth * force(depth) / (power + 1.0);
      const double stiffness = power * force(depth) / depth;
      const double way = kStep * kSpeed;
      const double work =
          way * (force(depth) + 4.0 * force(depth - 0.5 * way) + force(depth - way)) / 6.0;
      EXPECT_NEAR(end_excess(energy, force(depth), stiffness, 1.0, kSpeed, kStep),
                  std::max(0.0, work - energy), 1e-9 * energy)
          << power << " " << depth;
      worst = std::max(worst, (work - energy) / (kRate * way * way));
    }
    EXPECT_EQ(end_excess(1.0, 1.0, 1.0, 1.0, -kSpeed, kStep), 0.0);  // it comes in
  }
  EXPECT_NEAR(worst, 1.0 / 72.0, 1e-4);
}

}  // namespace
}  // namespace volcontact::work_limit_test
