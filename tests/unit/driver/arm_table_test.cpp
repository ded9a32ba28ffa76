#include "arm_table.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace thimble::driver {
namespace {

TEST(ArmTable, NamesEveryProtocolAndGeometryOnce) {
  std::set<std::string_view> names;
  std::set<ArmKind> kinds;
  for (const ArmRow& row : arm_table()) {
    EXPECT_TRUE(names.insert(row.protocol).second) << row.protocol;
    EXPECT_TRUE(kinds.insert(row.kind).second) << row.protocol;
    EXPECT_EQ(row_of(row.kind), &row);
    EXPECT_GT(row.board_count, 0u) << row.protocol;
  }
  for (const ShapeRow& row : arm_shapes()) EXPECT_TRUE(names.insert(row.name).second) << row.name;
  EXPECT_EQ(kinds.count(ArmKind::kUnsupported), 0u);
  EXPECT_EQ(row_of(ArmKind::kUnsupported), nullptr);
  EXPECT_EQ(make_arm(ArmKind::kUnsupported, {}), nullptr);
}

TEST(ArmTable, HasTheProtocolsOfEachBoard) {
  EXPECT_EQ(kind_of(BoardKind::kMbedHid8), ArmKind::kWoody);
  EXPECT_EQ(kind_of(BoardKind::kMbedHid14), ArmKind::kPolhem);
  EXPECT_EQ(kind_of(BoardKind::kTeensyRawHid64), ArmKind::kPolhem);
  EXPECT_EQ(kind_of(BoardKind::kTextLines), ArmKind::kHfabLine);
  EXPECT_EQ(kind_of(BoardKind::kFalconFtdi), ArmKind::kFalcon);
  EXPECT_EQ(kind_of(BoardKind::kHaplyService), ArmKind::kHaply);
  EXPECT_EQ(kind_of(BoardKind::kDhdLibrary), ArmKind::kDhd);
  EXPECT_EQ(kind_of(BoardKind::kHdLibrary), ArmKind::kHd);
  EXPECT_EQ(kind_of(BoardKind::kOther), ArmKind::kUnsupported);
}

TEST(ArmTable, ModelsAreInTheOrderOfTheGeometries) {
  for (std::size_t i = 0; i < arm_shapes().size(); ++i) {
    const ShapeRow& row = arm_shapes()[i];
    if (row.built_in == nullptr) continue;
    EXPECT_EQ(row.built_in().geometry.index(), i) << row.name;
    EXPECT_GT(row.built_in().drives[0].current_max, 0) << row.name;
  }
}

TEST(ArmTable, MakesAnArmForEveryGeometryAndProtocol) {
  for (const ArmRow& row : arm_table()) {
    for (const ShapeRow& shape : arm_shapes()) {
      if (shape.built_in == nullptr) continue;
      const ArmModel model = shape.built_in();
      const auto arm = make_arm(row.kind, model);
      if (row.has_own_link() || std::holds_alternative<VendorPoseArm>(model.geometry)) {
        EXPECT_EQ(arm, nullptr) << row.protocol << shape.name;
        continue;
      }
      ASSERT_NE(arm, nullptr);
      EXPECT_EQ(arm->drives(), model.drives) << row.protocol << shape.name;
      EXPECT_TRUE(arm->pose({}).p_BT.allFinite()) << row.protocol << shape.name;
    }
  }
}

}  // namespace
}  // namespace thimble::driver
