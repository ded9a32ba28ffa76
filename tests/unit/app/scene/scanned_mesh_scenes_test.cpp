#include "files/scanned_meshes.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "bringup/doctor_files.h"
#include "support/scratch.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

/// Temporary folders, so that no file of this machine is used.
class ScannedMeshes : public ::testing::Test {
 protected:
  ScannedMeshes()
      : root_(support::scratch_folder() /
              (std::string("scans_") +
               testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::remove_all(root_);
    places_ = {.folders = {root_ / "first", root_ / "second"},
               .archive = root_ / "data.tar.gz",
               .unpacked = root_ / "cache/meshes"};
  }

  void write(const fs::path& file, const std::string& text) const {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }

  /// Packs a scan in the same way as the Debian package.
  void pack(const std::string& name) const {
    write("packed/data/meshes/" + name, "OFF\n");
    const std::string command = "tar -czf '" + (root_ / "data.tar.gz").string() + "' -C '" +
                                (root_ / "packed").string() + "' data";
    ASSERT_EQ(std::system(command.c_str()), 0);
  }

  fs::path root_;
  ScanPlaces places_;
};

TEST_F(ScannedMeshes, ComeFromTheFirstFolderThatHasThem) {
  write("second/cow.off", "OFF\n");
  EXPECT_EQ(find_scan("cow.off", places_).value(), root_ / "second/cow.off");
  write("first/cow.off", "OFF\n");
  EXPECT_EQ(find_scan("cow.off", places_).value(), root_ / "first/cow.off");
}

TEST_F(ScannedMeshes, AreUnpackedOnFirstUseAndOnceOnly) {
  pack("cow.off");
  const fs::path unpacked = root_ / "cache/meshes/cow.off";
  ASSERT_EQ(find_scan("cow.off", places_).value(), unpacked);
  EXPECT_TRUE(fs::exists(unpacked));
  fs::remove(root_ / "data.tar.gz");
  EXPECT_EQ(find_scan("cow.off", places_).value(), unpacked);
  EXPECT_FALSE(find_scan("horse.off", places_));
}

TEST_F(ScannedMeshes, InAFolderAreNotUnpacked) {
  pack("cow.off");
  write("first/cow.off", "OFF\n");
  ASSERT_TRUE(find_scan("cow.off", places_));
  EXPECT_FALSE(fs::exists(root_ / "cache"));
}

TEST_F(ScannedMeshes, DamagedArchiveLeavesNothingBehind) {
  write("data.tar.gz", "no archive");
  const auto found = find_scan("cow.off", places_);
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().message.find("Cannot unpack"), std::string::npos)
      << found.error().message;
  EXPECT_TRUE(fs::is_empty(root_ / "cache"));
}

TEST_F(ScannedMeshes, MissingOnesAreReportedWithTheRemedy) {
  const std::string said = find_scan("cow.off", places_).error().message;
  for (const std::string& words :
       {std::string("cow.off"), (root_ / "first").string(), (root_ / "second").string(),
        places_.unpacked.string(), std::string("libcgal-demo"), std::string("water_balloon")}) {
    EXPECT_NE(said.find(words), std::string::npos) << said;
  }
}

TEST_F(ScannedMeshes, EnvironmentFolderReplacesAllOthers) {
  const char* before = std::getenv("THIMBLE_MESHES");
  const std::string kept = before != nullptr ? before : "";
  setenv("THIMBLE_MESHES", "/own/scans", 1);
  const ScanPlaces places = scan_places();
  unsetenv("THIMBLE_MESHES");
  const ScanPlaces usual = scan_places();
  if (before != nullptr) setenv("THIMBLE_MESHES", kept.c_str(), 1);
  EXPECT_EQ(places.folders, std::vector<fs::path>{"/own/scans"});
  EXPECT_TRUE(places.archive.empty() && places.unpacked.empty());
  EXPECT_EQ(usual.archive, "/usr/share/doc/libcgal-dev/data.tar.gz");
  EXPECT_EQ(usual.unpacked.filename(), "meshes");
}

TEST_F(ScannedMeshes, AreFoundByTheDoctorThatUnpacksNothing) {
  using bringup::examine_scans;
  const bringup::Finding none = bringup::examine_scans(places_);
  EXPECT_EQ(none.health, bringup::Health::kAdvice);
  EXPECT_NE(none.remedy.find("libcgal-demo"), std::string::npos);
  pack("elephant.off");
  const bringup::Finding packed = bringup::examine_scans(places_);
  EXPECT_EQ(packed.health, bringup::Health::kGood);
  EXPECT_NE(packed.what.find("on first use"), std::string::npos) << packed.what;
  EXPECT_FALSE(fs::exists(root_ / "cache"));
  write("second/elephant.off", "OFF\n");
  const std::string said = bringup::examine_scans(places_).what;
  EXPECT_NE(said.find("are in " + (root_ / "second").string()), std::string::npos) << said;
  EXPECT_LT(said.find((root_ / "first").string()), said.find((root_ / "second (there)").string()))
      << said;
}

}  // namespace
}  // namespace thimble::scene
