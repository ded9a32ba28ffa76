#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "output/folder_lock.h"
#include "output/output_file.h"
#include "output/output_plan.h"
#include "output/standard_streams.h"
#include "support/scratch.h"
#include "text_file.h"

namespace thimble::output {
namespace {

namespace fs = std::filesystem;

/// Fixture with a separate folder for each test.
class OutputTest : public ::testing::Test {
 protected:
  OutputTest() {
    folder_ =
        support::scratch_folder() / ::testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::create_directories(folder_);
  }

  fs::path file(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  /// Returns the number of files in the folder.
  std::ptrdiff_t files() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

  fs::path folder_;
};

constexpr const char* kOldTable = "time,force\n1,2\n";
constexpr const char* kNewTable = "time,force\n3,4\n";

mode_t mode_of(const fs::path& file) {
  struct stat about {};
  return ::stat(file.c_str(), &about) == 0 ? about.st_mode & 0777 : 0;
}

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

using OutputPathTest = OutputTest;

TEST_F(OutputPathTest, HardLinkIsTheSamePlace) {
  const fs::path a = file("a", "x");
  fs::create_hard_link(a, folder_ / "b");
  EXPECT_TRUE(same_place(resolve_output(a).value(), resolve_output(folder_ / "b").value()));
}

TEST_F(OutputPathTest, SymbolicLinkIsTheSamePlace) {
  const fs::path a = file("a", "x");
  fs::create_symlink("a", folder_ / "b");
  EXPECT_TRUE(same_place(resolve_output(a).value(), resolve_output(folder_ / "b").value()));
}

TEST_F(OutputPathTest, NewNameIsTheSameThroughALinkedFolder) {
  fs::create_directory(folder_ / "real");
  fs::create_symlink("real", folder_ / "linked");
  const auto a = resolve_output(folder_ / "real" / "new.csv");
  const auto b = resolve_output(folder_ / "linked" / "new.csv");
  const auto c = resolve_output(folder_ / "linked" / "other.csv");
  EXPECT_TRUE(same_place(a.value(), b.value()));
  EXPECT_FALSE(same_place(a.value(), c.value()));
}

TEST_F(OutputPathTest, LinkLoopsAreRejected) {
  fs::create_symlink("b", folder_ / "a");
  fs::create_symlink("a", folder_ / "b");
  const auto place = resolve_output(folder_ / "a");
  ASSERT_FALSE(place);
  EXPECT_TRUE(holds(place.error().message, "loop")) << place.error().message;
}

TEST_F(OutputPathTest, MissingFolderIsNamed) {
  const auto place = resolve_output(folder_ / "none" / "a.csv");
  ASSERT_FALSE(place);
  EXPECT_TRUE(holds(place.error().message, "none does not exist")) << place.error().message;
}

using OutputFileTest = OutputTest;

TEST_F(OutputFileTest, OldFileStaysUntilTheNewOneIsComplete) {
  const fs::path path = file("a.csv", kOldTable);
  auto output = OutputFile::open(path, kTable);
  ASSERT_TRUE(output) << output.error().message;
  ASSERT_TRUE(output->write(kNewTable));
  EXPECT_EQ(scene::text_of(path), kOldTable);
  ASSERT_TRUE(output->commit());
  EXPECT_EQ(scene::text_of(path), kNewTable);
  EXPECT_EQ(files(), 1);
}

TEST_F(OutputFileTest, AbandonedOutputLeavesNothing) {
  { ASSERT_TRUE(OutputFile::open(folder_ / "a.csv", kTable)); }
  EXPECT_EQ(files(), 0);
}

TEST_F(OutputFileTest, SymbolicLinkStaysAndItsTargetIsReplaced) {
  const fs::path path = file("a.csv", kOldTable);
  fs::create_symlink("a.csv", folder_ / "link.csv");
  ASSERT_TRUE(write_file(folder_ / "link.csv", kTable, kNewTable));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.csv"));
  EXPECT_EQ(scene::text_of(path), kNewTable);
}

TEST_F(OutputFileTest, DanglingLinkGetsItsTarget) {
  fs::create_symlink("later.csv", folder_ / "link.csv");
  ASSERT_TRUE(write_file(folder_ / "link.csv", kTable, kNewTable));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.csv"));
  EXPECT_EQ(scene::text_of(folder_ / "later.csv"), kNewTable);
}

TEST_F(OutputFileTest, SecondWriterIsRefused) {
  const auto first = OutputFile::open(folder_ / "a.csv", kTable);
  ASSERT_TRUE(first);
  const auto second = OutputFile::open(folder_ / "a.csv", kTable);
  ASSERT_FALSE(second);
  EXPECT_TRUE(holds(second.error().message, "being written")) << second.error().message;
}

TEST_F(OutputFileTest, SecondWriterIsRefusedAfterPublication) {
  auto first = OutputFile::open(folder_ / "a.csv", kTable);
  ASSERT_TRUE(first && first->write(kOldTable) && first->publish());
  EXPECT_FALSE(OutputFile::open(folder_ / "a.csv", kTable));
  ASSERT_TRUE(first->commit());
  EXPECT_TRUE(OutputFile::open(folder_ / "a.csv", kTable));
}

TEST_F(OutputFileTest, FileOfAnotherKindIsKept) {
  for (const OutputKind* kind :
       {&kTable, &kSound, &kPng, &kSvg, &kAnimation, &kMesh, &kPageFile, &kJson, &kXml, &kWebPage,
        &kArmFile, &kQualityTable, &kMotionTrace, &kLogFile}) {
    const fs::path path = file("scene.yaml", "# An arm, a ball: both at rest\nname: precious\n");
    const auto refused = write_file(path, *kind, "new");
    EXPECT_FALSE(refused) << kind->name;
    EXPECT_TRUE(holds(scene::text_of(path), "precious")) << kind->name;
  }
}

TEST_F(OutputFileTest, WebPageOfAnotherProgramIsKept) {
  const fs::path path = file("index.html", "<!doctype html><title>My home</title>");
  EXPECT_FALSE(write_file(path, kWebPage, "<!doctype html><title>Thimble</title>"));
}

TEST_F(OutputFileTest, EmptyFileIsReplaced) {
  const fs::path path = file("a.csv", "");
  EXPECT_TRUE(write_file(path, kTable, kNewTable));
}

TEST_F(OutputFileTest, PartOfAKilledWriterIsUsedAgain) {
  file("a.thimble-part.csv", "time,fo");
  ASSERT_TRUE(write_file(folder_ / "a.csv", kTable, kNewTable));
  EXPECT_EQ(scene::text_of(folder_ / "a.csv"), kNewTable);
  EXPECT_EQ(files(), 1);
}

TEST_F(OutputFileTest, PartThatIsALinkIsRefused) {
  const fs::path other = file("other.csv", kOldTable);
  fs::create_symlink("other.csv", folder_ / "a.thimble-part.csv");
  EXPECT_FALSE(write_file(folder_ / "a.csv", kTable, kNewTable));
  EXPECT_EQ(scene::text_of(other), kOldTable);
}

TEST_F(OutputFileTest, PartWithAHardLinkIsRefused) {
  const fs::path other = file("other.csv", kOldTable);
  fs::create_hard_link(other, folder_ / "a.thimble-part.csv");
  EXPECT_FALSE(write_file(folder_ / "a.csv", kTable, kNewTable));
  EXPECT_EQ(scene::text_of(other), kOldTable);
}

TEST_F(OutputFileTest, OwnerOnlyHoldsFromCreationForAnyUmask) {
  constexpr OutputKind kSecret{
      .name = "a secret", .matches = [](const fs::path&) { return true; }, .owner_only = true};
  const mode_t before = ::umask(0);
  const auto output = OutputFile::open(folder_ / "secret", kSecret);
  ::umask(before);
  ASSERT_TRUE(output);
  EXPECT_EQ(mode_of(output->part()), 0600U);
}

TEST_F(OutputFileTest, NewFileIsReadableAndWritableWithinTheUmask) {
  const mode_t before = ::umask(0);
  const auto written = write_file(folder_ / "a.csv", kTable, kNewTable);
  ::umask(before);
  ASSERT_TRUE(written);
  EXPECT_EQ(mode_of(folder_ / "a.csv"), 0666U);
}

TEST_F(OutputFileTest, EmptyFileIsPlainText) {
  EXPECT_TRUE(kPlainText.matches(file("empty.txt", "")));
  EXPECT_FALSE(kPlainText.matches(file("zero.txt", std::string(1, '\0'))));
}

TEST_F(OutputFileTest, PipeStaysAfterAnAbandonedOutput) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  { ASSERT_TRUE(OutputFile::open(pipe, kTable)); }
  ::close(reader);
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(OutputFileTest, ReplacedFileKeepsItsMode) {
  const fs::path path = file("a.csv", kOldTable);
  ::chmod(path.c_str(), 0640);
  ASSERT_TRUE(write_file(path, kTable, kNewTable));
  EXPECT_EQ(mode_of(path), 0640U);
}

TEST_F(OutputFileTest, FullDiskKeepsTheOldFileAndLeavesNoPart) {
  const fs::path path = file("a.csv", kOldTable);
  const pid_t child = fork();
  if (child == 0) {
    // No byte can be written, as on a full disk.
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit none{1, 1};
    if (setrlimit(RLIMIT_FSIZE, &none) != 0) _exit(2);
    const auto written = write_file(path, kTable, kNewTable);
    _exit(written ? 3 : holds(written.error().message, "Free some space") ? 0 : 4);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_EQ(scene::text_of(path), kOldTable);
  EXPECT_EQ(files(), 1);
}

/// Returns a device like one of /dev. Root gets its own node, because a fault of the writer could
/// replace that of the system.
fs::path device(const fs::path& folder, const char* name, unsigned minor) {
  const fs::path own = folder / name;
  const bool made = geteuid() == 0 && ::mknod(own.c_str(), S_IFCHR | 0666, makedev(1, minor)) == 0;
  const int opened = made ? ::open(own.c_str(), O_WRONLY | O_CLOEXEC) : -1;
  if (opened < 0) return fs::path("/dev") / name;  // or the file system has no devices
  ::close(opened);
  return own;
}

TEST_F(OutputFileTest, DeviceIsWrittenDirectly) {
  const fs::path null = device(folder_, "null", 3), full = device(folder_, "full", 7);
  EXPECT_TRUE(write_file(null, kTable, kNewTable));
  EXPECT_TRUE(fs::is_character_file(null));
  EXPECT_FALSE(write_file(full, kTable, kNewTable));
  EXPECT_TRUE(fs::is_character_file(full));
}

TEST_F(OutputFileTest, PipeWithoutReaderDoesNotHang) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  const auto written = write_file(folder_ / "pipe", kTable, kNewTable);
  ASSERT_FALSE(written);
  EXPECT_TRUE(holds(written.error().message, "reader")) << written.error().message;
}

TEST_F(OutputFileTest, LongNameIsWritten) {
  const fs::path path = folder_ / (std::string(251, 'n') + ".csv");
  ASSERT_TRUE(write_file(path, kTable, kNewTable));
  EXPECT_EQ(scene::text_of(path), kNewTable);
}

TEST_F(OutputFileTest, DescriptorIsNotInherited) {
  const auto output = OutputFile::open(folder_ / "a.csv", kTable);
  ASSERT_TRUE(output);
  EXPECT_NE(fcntl(output->descriptor(), F_GETFD) & FD_CLOEXEC, 0);
}

TEST_F(OutputFileTest, SharedLogIsNotLocked) {
  const fs::path path = file("a.log", "2026-01-31T12:00:00.000+00:00 info 1 a: b\n");
  const int other = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(::flock(other, LOCK_EX | LOCK_NB), 0);
  EXPECT_TRUE(check_replaceable(path, resolve_output(path).value(), kLogFile, false));
  ::close(other);
}

using OutputPlanTest = OutputTest;

TEST_F(OutputPlanTest, InputIsRejectedAsOutputThroughAnyLink) {
  const fs::path input = file("in.csv", kOldTable);
  fs::create_hard_link(input, folder_ / "hard.csv");
  fs::create_symlink("in.csv", folder_ / "soft.csv");
  for (const char* name : {"in.csv", "hard.csv", "soft.csv"}) {
    OutputPlan plan;
    plan.read(input);
    plan.write("--csv", folder_ / name, kTable);
    const auto begun = plan.begin();
    ASSERT_FALSE(begun) << name;
    EXPECT_TRUE(holds(begun.error().message, "--csv: ")) << begun.error().message;
    EXPECT_TRUE(holds(begun.error().message, "an input")) << begun.error().message;
  }
  EXPECT_EQ(scene::text_of(input), kOldTable);
}

TEST_F(OutputPlanTest, TwoOutputsOfOneNameAreRefused) {
  OutputPlan plan;
  plan.write("--json", folder_ / "new", kJson);
  plan.write("--junit", folder_ / "." / "new", kXml);
  const auto begun = plan.begin();
  ASSERT_FALSE(begun);
  EXPECT_TRUE(holds(begun.error().message, "--json and --junit")) << begun.error().message;
}

TEST_F(OutputPlanTest, FileInAnOutputFolderIsNoOtherOutput) {
  OutputPlan plan;
  plan.write("--json", folder_ / "figures.json", kJson);
  plan.write_folder("--output", folder_, {"figures.json"});
  EXPECT_FALSE(plan.begin());
}

TEST_F(OutputPlanTest, WriterTakesOverReservedOutputs) {
  OutputPlan plan;
  plan.write("--csv", folder_ / "a.csv", kTable);
  ASSERT_TRUE(plan.begin());
  EXPECT_TRUE(write_file(folder_ / "a.csv", kTable, kNewTable));
  EXPECT_EQ(scene::text_of(folder_ / "a.csv"), kNewTable);
}

TEST_F(OutputPlanTest, UnwrittenOutputsAndNewFoldersAreRemoved) {
  {
    OutputPlan plan;
    plan.write("--csv", folder_ / "a.csv", kTable);
    plan.write_folder("--output", folder_ / "new" / "deep", {"figures.json"});
    ASSERT_TRUE(plan.begin());
    EXPECT_EQ(files(), 2);
  }
  EXPECT_EQ(files(), 0);
}

TEST_F(OutputPlanTest, FileOfAnotherKindInAFolderIsFoundAtOnce) {
  file("index.html", "<!doctype html><title>My home</title>");
  OutputPlan plan;
  plan.write_folder("--report", folder_, {"report.json", "index.html"});
  const auto begun = plan.begin();
  ASSERT_FALSE(begun);
  EXPECT_TRUE(holds(begun.error().message, "index.html")) << begun.error().message;
}

TEST_F(OutputPlanTest, FileIsRejectedAsFolder) {
  OutputPlan plan;
  plan.write_folder("--report", file("a_file", "x"), {});
  EXPECT_FALSE(plan.begin());
}

TEST_F(OutputPlanTest, DataFolderOfPlotsIsCheckedAtOnce) {
  {
    OutputPlan plan;
    plan.write_folder("--report", folder_, {});
    EXPECT_TRUE(plan.begin());
  }
  file("data", "in the way");
  OutputPlan plan;
  plan.write_folder("--report", folder_, {});
  const auto begun = plan.begin();
  ASSERT_FALSE(begun);
  EXPECT_TRUE(holds(begun.error().message, "--report")) << begun.error().message;
  EXPECT_TRUE(holds(begun.error().message, "data")) << begun.error().message;
}

TEST_F(OutputPlanTest, NewFolderMustBeEmpty) {
  file("precious", "x");
  OutputPlan plan;
  plan.write_new_folder("--bag", folder_);
  EXPECT_FALSE(plan.begin());
}

TEST_F(OutputPlanTest, InputsFoundLaterAreCompared) {
  const fs::path mesh = file("ball.off", "OFF\n0 0 0\n");
  OutputPlan plan;
  plan.write("--save-mesh", mesh, kMesh);
  ASSERT_TRUE(plan.begin());
  plan.read(mesh);
  EXPECT_FALSE(plan.begin());
}

TEST_F(OutputPlanTest, FolderOfAnotherProcessIsRefused) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    const auto lock = FolderLock::take(folder_);
    if (write(ends[1], "x", 1) != 1) _exit(1);
    pause();
  }
  char ready = 0;
  ASSERT_EQ(read(ends[0], &ready, 1), 1);
  {
    OutputPlan plan;
    plan.write_folder("--report", folder_, {});
    const auto begun = plan.begin();
    ASSERT_FALSE(begun);
    EXPECT_TRUE(holds(begun.error().message, "being written by process " + std::to_string(child)))
        << begun.error().message;
  }
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_TRUE(FolderLock::take(folder_));
}

TEST(StandardStreams, ClosedOnesAreOpenedOnDevNull) {
  const pid_t child = fork();
  if (child == 0) {
    for (int stream = 0; stream < 3; ++stream) close(stream);
    if (!open_standard_streams()) _exit(1);
    struct stat null {};
    if (stat("/dev/null", &null) != 0) _exit(2);
    for (int stream = 0; stream < 3; ++stream) {
      struct stat about {};
      if (fstat(stream, &about) != 0 || about.st_rdev != null.st_rdev) _exit(3 + stream);
    }
    _exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(StandardStreams, OpenOnesStay) {
  struct stat before {
  }, after{};
  ASSERT_EQ(fstat(STDERR_FILENO, &before), 0);
  EXPECT_TRUE(open_standard_streams());
  ASSERT_EQ(fstat(STDERR_FILENO, &after), 0);
  EXPECT_EQ(before.st_ino, after.st_ino);
}

}  // namespace
}  // namespace thimble::output
