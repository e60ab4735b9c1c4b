// SPDX-License-Identifier: Apache-2.0
#include "adaptor/evaluation/work_sharing.h"

#include <gtest/gtest.h>
#include <omp.h>
#include <sys/wait.h>
#include <unistd.h>

#include <thread>

namespace volcontact::adaptor::work_sharing_test {
namespace {

TEST(WorkSharing, AloneAnEvaluationGetsTheThreadsItWants) {
  EXPECT_EQ(EvaluationGuard(3).threads(), 3);
  EXPECT_EQ(EvaluationGuard(0).threads(), omp_get_max_threads());
}

TEST(WorkSharing, LimitHoldsForOpenMPAndIsTakenBack) {
  const int before = omp_get_max_threads();
  {
    const EvaluationGuard guard(before + 2);
    EXPECT_EQ(omp_get_max_threads(), before + 2);
  }
  EXPECT_EQ(omp_get_max_threads(), before);
}

TEST(WorkSharing, WhileAnotherThreadEvaluatesThereIsOne) {
  const EvaluationGuard first(4);
  int of_second = 0;
  std::thread([&] { of_second = EvaluationGuard(4).threads(); }).join();
  EXPECT_EQ(of_second, 1);
}

TEST(WorkSharing, ForkedChildHasOneAndComesToAnEnd) {
#pragma omp parallel num_threads(2)
  {
  }  // now the threads of OpenMP exist, in this process
  const pid_t child = fork();
  if (child == 0) {
    alarm(20);
    const EvaluationGuard guard(4);
    int sum = 0;
#pragma omp parallel for reduction(+ : sum)
    for (int i = 0; i < 100; ++i) sum += i;
    _exit(guard.threads() == 1 && sum == 4950 ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace volcontact::adaptor::work_sharing_test
