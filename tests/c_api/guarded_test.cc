// SPDX-License-Identifier: Apache-2.0
#include <thread>

#include "c_api/support.h"

namespace volcontact::c_api::testing::guarded_test {
namespace {

TEST(CVersion, HeaderAndLibraryMustAgreeInMinor) {
  EXPECT_EQ(vc_version(), VC_VERSION);
  EXPECT_EQ(vc_check_version(VC_VERSION), 0);
  EXPECT_EQ(vc_check_version(VC_VERSION / 100 * 100 + 7), 0);  // another patch
  EXPECT_TRUE(fails(vc_check_version(VC_VERSION + 100), VC_ERROR_VERSION,
                    {"header of version 200", "library has 100", "compile it"}));
}

TEST(CErrors, NullPointersAreNamed) {
  EXPECT_TRUE(fails(vc_solid_create("box", nullptr), VC_ERROR_ARGUMENT,
                    {"vc_solid_create: solid is null"}));
  EXPECT_TRUE(fails(vc_model_create(nullptr), VC_ERROR_ARGUMENT, {"vc_model_create"}));
  EXPECT_TRUE(fails(vc_workspace_create(nullptr), VC_ERROR_ARGUMENT, {"vc_workspace_create"}));
  EXPECT_TRUE(fails(vc_sites(nullptr, nullptr, 0), VC_ERROR_ARGUMENT, {"workspace is null"}));
  vc_solid_free(nullptr);
  vc_model_free(nullptr);
  vc_workspace_free(nullptr);
}

TEST(CErrors, EachThreadHasItsOwnText) {
  vc_solid_create("boks", nullptr);
  const std::string before = vc_error();
  std::thread([] {
    EXPECT_STREQ(vc_error(), "");
    vc_model_create(nullptr);
    EXPECT_NE(std::string(vc_error()).find("vc_model_create"), std::string::npos);
  }).join();
  EXPECT_EQ(vc_error(), before);
}

}  // namespace
}  // namespace volcontact::c_api::testing::guarded_test
