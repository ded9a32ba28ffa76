#include <gtest/gtest.h>
#include <png.h>

#include <Eigen/Geometry>
#include <complex>
#include <fstream>
#include <limits>
#include <numbers>

#include "field/primitive_contact.h"
#include "support/heap_guard.h"
#include "support/random.h"
#include "support/scratch.h"
#include "support/variant_settings.h"
#include "surface/texture/height_map.h"
#include "surface/texture/sandpaper.h"
#include "surface/texture/sines.h"
#include "thimble/render/field/half_space.h"
#include "thimble/render/field/sphere.h"
#include "thimble/render/object_touch.h"
#include "thimble/render/surface/spring_damper.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::VariantSettings;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kStiffness = 800;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

driver::DeviceState at(const Vector3d& p_WT) {
  driver::DeviceState state;
  state.p_WT = p_WT;
  return state;
}

EffectContext context() {
  EffectContext known;
  known.force_max = 5;
  known.surface_stiffness = kStiffness;
  known.R_WO = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  known.p_WO = {0.001, -0.002, 0.003};
  return known;
}

Sines::Settings two_waves(TextureForm form) {
  Sines::Settings settings;
  settings.form = form;
  settings.waves = {
      {.amplitude = 0.0001, .wavelength = 0.002, .direction = {1, 0, 0}, .phase = 0.3},
      {.amplitude = 0.00005, .wavelength = 0.001, .direction = {1, 1, 0}, .phase = 1}};
  return settings;
}

/// Returns an image of one sine in each direction, as heights.
std::shared_ptr<const HeightImage> egg_box(std::size_t side) {
  std::vector<float> values;
  for (std::size_t row = 0; row < side; ++row) {
    for (std::size_t column = 0; column < side; ++column) {
      const double u = kTurn * static_cast<double>(column) / static_cast<double>(side);
      const double v = kTurn * static_cast<double>(row) / static_cast<double>(side);
      values.push_back(static_cast<float>(0.5 + 0.25 * (std::sin(u) + std::sin(v))));
    }
  }
  return std::make_shared<const HeightImage>(side, side, std::move(values));
}

HeightMap::Settings egg_box_map(TextureForm form, HeightMap::Along along) {
  HeightMap::Settings settings;
  settings.form = form;
  settings.image = egg_box(16);
  settings.width = 0.004;
  settings.height = 0.0003;
  settings.along = along;
  return settings;
}

// Returns the force on the tip at a place, after one tick outside.
template <class Shape, class Stage>
Vector3d force_at(const Shape& shape, const Stage& stage, const Vector3d& p_W) {
  ContactForceLaw touch{PrimitiveContact(shape), stage, SpringDamper{kStiffness, 0}};
  touch(at({0.3, 0.4, 0.9}));
  return touch(at(p_W)).f_T_W;
}

// Returns the work of a force around a smooth closed path; the sum over even steps of a smooth
// closed path converges faster than any power of their number. `gross` sums the magnitudes.
template <class Force, class Way>
double work_around(const Force& force, const Way& way, int steps, double& gross) {
  double work = 0;
  for (int i = 0; i < steps; ++i) {
    const double s = kTurn * i / steps;
    // The path's direction by a five-point rule, exact to rounding for these few harmonics.
    const double e = 1e-3;
    const Vector3d direction =
        (8 * (way(s + e) - way(s - e)) - (way(s + 2 * e) - way(s - 2 * e))) / (12 * e);
    const double power = force(way(s)).dot(direction);
    work += power;
    gross += std::abs(power);
  }
  return work;
}

// A loop below a wall at z = 0, deeper on one side of a wave than on the other.
Vector3d below_wall(double s) {
  return {0.0006 * std::cos(s), 0.0004 * std::sin(s), -0.002 + 0.0007 * std::sin(s + 1)};
}

template <class Stage>
void expect_work_around(const Stage& stage, bool conservative, const char* what) {
  const HalfSpace wall;
  double gross = 0;
  const double work = work_around([&](const Vector3d& p) { return force_at(wall, stage, p); },
                                  below_wall, 20000, gross);
  std::printf("work around a closed way, %s: %.2e of what goes in and out\n", what, work / gross);
  if (conservative) {
    EXPECT_LT(std::abs(work), 1e-9 * gross) << what;
  } else {
    EXPECT_GT(std::abs(work), 1e-3 * gross) << what;
  }
}

TEST(Textures, LateralTexturesDoNoWorkOnAClosedPath) {
  Sandpaper::Settings rough;
  rough.roughness = 0.00005;
  rough.wavelength = 0.0015;
  const EffectContext known = context();
  expect_work_around(Sines(two_waves(TextureForm::kConservative), known), true, "sines");
  expect_work_around(Sandpaper(rough, known), true, "sandpaper");
  EffectContext straight = known;
  straight.R_WO.setIdentity();
  expect_work_around(
      HeightMap(egg_box_map(TextureForm::kConservative, HeightMap::Along::kAll), straight), true,
      "height map");
  expect_work_around(
      HeightMap(egg_box_map(TextureForm::kConservative, HeightMap::Along::kX), known), true,
      "height map on a slanted axis");
  rough.form = TextureForm::kDepthOnly;
  expect_work_around(Sines(two_waves(TextureForm::kDepthOnly), known), false, "sines, depth only");
  expect_work_around(Sandpaper(rough, known), false, "sandpaper, depth only");
  expect_work_around(
      HeightMap(egg_box_map(TextureForm::kDepthOnly, HeightMap::Along::kAll), straight), false,
      "height map, depth only");
}

TEST(Textures, DoNoWorkOnAClosedPathInASphere) {
  const Sphere ball{.p_WO = {0, 0, 0}, .radius = 0.02};
  const Sines waves(two_waves(TextureForm::kConservative), context());
  const auto way = [](double s) -> Vector3d {
    return (0.018 + 0.0007 * std::sin(2 * s)) *
           Vector3d(std::cos(s), std::sin(s), 0.5 * std::sin(s + 1)).normalized();
  };
  double gross = 0;
  const double work =
      work_around([&](const Vector3d& p) { return force_at(ball, waves, p); }, way, 20000, gross);
  // The five-point rule is the limit here: this path has all harmonics.
  EXPECT_LT(std::abs(work), 1e-9 * gross);
}

TEST(Textures, PushWithTheGradientOfTheSpringsEnergy) {
  support::Random random(1);
  const EffectContext known = context();
  const Sines waves(two_waves(TextureForm::kConservative), known);
  const auto energy = [&](const Vector3d& p) {
    const Vector3d closest(p.x(), p.y(), 0);
    const double depth = -p.z() + waves.height().at(closest).height;
    return depth > 0 ? kStiffness * depth * depth / 2 : 0;
  };
  for (int i = 0; i < 1000; ++i) {
    const Vector3d p{random.uniform(-0.01, 0.01), random.uniform(-0.01, 0.01),
                     random.uniform(-0.003, 0)};
    const double e = 1e-8;
    Vector3d wanted;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const Vector3d step = e * Vector3d::Unit(axis);
      wanted[axis] = -(energy(p + step) - energy(p - step)) / (2 * e);
    }
    EXPECT_LT((force_at(HalfSpace(), waves, p) - wanted).norm(), 1e-5) << p.transpose();
  }
}

TEST(Textures, CutIntoSurfaceBeginsContactWithoutAStep) {
  const EffectContext known = context();
  const Sines waves(two_waves(TextureForm::kConservative), known);
  const Sandpaper rough({}, known);
  const HeightMap map(egg_box_map(TextureForm::kConservative, HeightMap::Along::kAll), known);
  support::Random random(2);
  double highest = -1;
  for (int i = 0; i < 20000; ++i) {
    const Vector3d p = random.in_box(0.02);
    highest = std::max(highest, waves.height().at(p).height);
    EXPECT_LE(waves.height().at(p).height, 0);
    EXPECT_GE(waves.height().at(p).height, -waves.height().relief());
    EXPECT_LE(rough.height().at(p).height, 0);
    EXPECT_LE(map.at(p, Vector3d::UnitZ()).height, 0);
    EXPECT_GE(map.at(p, Vector3d::UnitZ()).height, -0.0003);
    EXPECT_LT(force_at(HalfSpace(), waves, {p.x(), p.y(), -1e-9}).norm(), 1e-5);
  }
  EXPECT_GT(highest, -1e-5);  // and its peaks are in the surface
}

// An image without any symmetry of rotation or reflection.
TEST(HeightMaps, HaveTheSameOrientationOnEveryFace) {
  HeightMap::Settings settings;
  std::vector<float> values(64, 0.5f);
  for (std::size_t i = 0; i < 5; ++i) values[i * 8] = 1;  // an L
  for (std::size_t i = 0; i < 3; ++i) values[i] = 0.8f;
  settings.image = std::make_shared<const HeightImage>(8, 8, std::move(values));
  settings.width = 0.008;
  settings.height = 0.001;
  settings.along = HeightMap::Along::kAll;
  const HeightMap map(settings, {});
  support::Random random(6);
  for (int i = 0; i < 200; ++i) {
    const double u = random.uniform(0, 0.008), v = random.uniform(0, 0.008);
    const double wanted = map.at({u, v, 0}, Vector3d::UnitZ()).height;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {1.0, -1.0}) {
        const Vector3d n = side * Vector3d::Unit(axis);
        const Vector3d up = Vector3d::Unit((axis + 2) % 3);
        const Vector3d right = up.cross(n);  // as seen from outside, looking along -n
        const TextureHeight found = map.at(u * right + v * up, n);
        EXPECT_NEAR(found.height, wanted, 1e-12) << axis << " " << side;
        // The slope is the derivative of the height.
        const double e = 1e-8;
        EXPECT_NEAR(found.slope_M.dot(right),
                    (map.at((u + e) * right + v * up, n).height -
                     map.at((u - e) * right + v * up, n).height) /
                        (2 * e),
                    1e-4);
      }
    }
  }
}

TEST(Textures, GiveNoForceForNaNAndNeverPull) {
  const EffectContext known = context();
  const Sines waves(two_waves(TextureForm::kConservative), known);
  const Sandpaper rough({}, known);
  const HeightMap map(egg_box_map(TextureForm::kConservative, HeightMap::Along::kAll), known);
  const SpringDamper spring{kStiffness, 1};
  const auto felt = [&](auto stage, const ContactState& contact, const Vector3d& p_W) {
    SurfaceResponse response{.contact = contact};
    stage.touch(at(p_W), response);
    return spring.force(response.contact, at(p_W));
  };
  support::Random random(3);
  for (int i = 0; i < 10000; ++i) {
    ContactState contact;
    contact.touching = true;
    contact.depth = random.uniform(0, 0.005);
    contact.n_W = random.direction();
    const Vector3d p = random.in_box(0.05);
    contact.p_WP = p + contact.depth * contact.n_W;
    for (const Vector3d& f :
         {felt(waves, contact, p), felt(rough, contact, p), felt(map, contact, p)}) {
      ASSERT_TRUE(f.allFinite());
      ASSERT_GE(f.dot(contact.n_W), 0);
    }
    for (const double bad : {kNan, std::numeric_limits<double>::infinity(), 1e300}) {
      Vector3d q = p;
      q[i % 3] = bad;
      ContactState bad_contact = contact;
      ContactState far = contact;
      far.p_WP = q;
      (i % 2 ? bad_contact.depth : bad_contact.n_W[i % 3]) = kNan;
      // A tip far away is never in contact; this tests that nothing becomes infinite.
      ASSERT_TRUE(felt(waves, far, q).allFinite());
      ASSERT_TRUE(felt(rough, far, q).allFinite());
      ASSERT_TRUE(felt(map, far, q).allFinite());
      ASSERT_EQ(felt(waves, bad_contact, p), Vector3d::Zero());
      ASSERT_EQ(felt(rough, bad_contact, p), Vector3d::Zero());
      ASSERT_EQ(felt(map, bad_contact, p), Vector3d::Zero());
    }
  }
}

TEST(Textures, DoNotAllocate) {
  const EffectContext known = context();
  ContactForceLaw touch{
      PrimitiveContact(HalfSpace()), Sines(two_waves(TextureForm::kConservative), known),
      Sandpaper({}, known),
      HeightMap(egg_box_map(TextureForm::kConservative, HeightMap::Along::kAll), known),
      SpringDamper{kStiffness, 0}};
  touch(at({0, 0, 0.01}));
  driver::ForceCommand command;
  EXPECT_EQ(support::heap_calls_of([&] { command = touch(at({0, 0, -0.004})); }), 0);
  EXPECT_GT(command.f_T_W.z(), 1);
}

TEST(Sines, GiveTheForceTheLinesOfTheirWaves) {
  // Sliding at 0.05 m/s over waves of 2 and 1 mm at constant depth: 25 and 50 Hz, amplitude k a.
  Sines::Settings settings;
  settings.waves = {
      {.amplitude = 0.0001, .wavelength = 0.002, .direction = {1, 0, 0}, .phase = 0.4},
      {.amplitude = 0.00004, .wavelength = 0.001, .direction = {1, 0, 0}, .phase = 2}};
  const Sines waves(settings, EffectContext{});
  ContactForceLaw touch{PrimitiveContact(HalfSpace()), waves, SpringDamper{kStiffness, 0}};
  touch(at({0, 0, 0.01}));
  constexpr int kTicks = 1000;
  std::vector<double> push, aside;
  for (int k = 0; k < kTicks; ++k) {
    const Vector3d f = touch(at({0.05 * k * 0.001, 0, -0.002})).f_T_W;
    push.push_back(f.z());
    aside.push_back(f.x());
  }
  const auto line = [&](const std::vector<double>& f, int hertz) {
    std::complex<double> sum = 0;
    for (int k = 0; k < kTicks; ++k) {
      sum += f[static_cast<std::size_t>(k)] * std::polar(1.0, -kTurn * hertz * k / kTicks);
    }
    return std::abs(sum) * (hertz == 0 ? 1.0 : 2.0) / kTicks;
  };
  EXPECT_NEAR(line(push, 25), kStiffness * 0.0001, 1e-12);
  EXPECT_NEAR(line(push, 50), kStiffness * 0.00004, 1e-12);
  EXPECT_NEAR(line(push, 0), kStiffness * (0.002 - 0.00014), 1e-12);
  for (const int other : {10, 24, 26, 75, 100, 333}) EXPECT_LT(line(push, other), 1e-12);
  // Lateral: k (d - peaks) a 2 pi / L at 25 Hz, and the product of the two waves at 75 Hz.
  EXPECT_NEAR(line(aside, 75), kStiffness * 0.0001 * 0.00004 / 2 * kTurn * 1500, 1e-12);
  EXPECT_NEAR(line(aside, 0), 0, 1e-12);
}

TEST(Sandpaper, IsRepeatableAndHasTheRequestedRoughness) {
  Sandpaper::Settings settings;
  settings.roughness = 0.00004;
  const Sandpaper one(settings, EffectContext{}), again(settings, EffectContext{});
  settings.seed = 2;
  const Sandpaper other(settings, EffectContext{});
  support::Random random(4);
  double mean = 0, square = 0, different = 0;
  constexpr int kPlaces = 40000;
  for (int i = 0; i < kPlaces; ++i) {
    const Vector3d p = random.in_box(0.5);
    const double height = one.height().at(p).height;
    ASSERT_EQ(height, again.height().at(p).height);
    different += std::abs(height - other.height().at(p).height) > 1e-6;
    mean += height / kPlaces;
    square += height * height / kPlaces;
  }
  EXPECT_NEAR(std::sqrt(square - mean * mean), 0.00004, 0.02 * 0.00004);
  EXPECT_NEAR(mean, -one.height().relief() / 2, 0.02 * 0.00004);
  EXPECT_GT(different, 0.9 * kPlaces);
}

TEST(Sandpaper, HoldsNoWavesShorterThanItsBand) {
  // Along a straight line: the spectrum ends at sqrt 2 / wavelength.
  const Sandpaper rough({}, EffectContext{});  // wavelength 2 mm: 707 waves per metre
  constexpr int kPlaces = 4096;
  constexpr double kStep = 0.0001;
  std::vector<double> heights;
  for (int k = 0; k < kPlaces; ++k) {
    // A window with fast falling leakage, so that power beyond the limit is not due to the window.
    const double window = std::pow(std::sin(kTurn * k / kPlaces / 2), 6);
    const double height = rough.height().at({k * kStep, 0, 0}).height;
    heights.push_back(window * (height + rough.height().relief() / 2));
  }
  double within = 0, beyond = 0;
  for (int wave = 1; wave < kPlaces / 2; wave += 13) {
    const std::complex<double> turn = std::polar(1.0, -kTurn * wave / kPlaces);
    std::complex<double> sum = 0, phase = 1;
    for (const double height : heights) {
      sum += height * phase;
      phase *= turn;
    }
    (wave / (kPlaces * kStep) < 730 ? within : beyond) += std::norm(sum);
  }
  EXPECT_LT(beyond, 1e-9 * within);
}

// Writes a grey PNG, 8 bits per pixel, rows from the top.
std::filesystem::path write_png(const std::string& name, std::uint32_t width, std::uint32_t height,
                                const std::vector<unsigned char>& grey) {
  const auto file = support::scratch_folder() / name;
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = PNG_FORMAT_GRAY;
  EXPECT_TRUE(png_image_write_to_file(&image, file.c_str(), 0, grey.data(), 0, nullptr));
  return file;
}

TEST(HeightImage, ReadsAPngAsItsGreyValuesWithTheTopUp) {
  std::vector<unsigned char> grey(4 * 3, 51);  // 0.2
  const auto flat = HeightImage::load(write_png("flat.png", 4, 3, grey));
  ASSERT_TRUE(flat) << flat.error().message;
  EXPECT_EQ(flat->width(), 4u);
  EXPECT_EQ(flat->height(), 3u);
  for (const double u : {-7.3, 0.0, 2.5, 1e6}) EXPECT_NEAR(flat->at(u, -u).value, 0.2, 1e-7);
  std::fill(grey.begin(), grey.begin() + 4, static_cast<unsigned char>(255));  // the top row
  const auto bright = HeightImage::load(write_png("bright.png", 4, 3, grey));
  ASSERT_TRUE(bright);
  EXPECT_NEAR(bright->at(0, 2).value, 0.2 + 0.8 * 4 / 6, 1e-6);  // the spline's weight of a row
  EXPECT_NEAR(bright->at(0, 0).value, 0.2 + 0.8 / 6, 1e-6);
  EXPECT_GT(bright->at(0, 1).dv, 0);
}

TEST(HeightImage, RefusesWhatIsNoPictureWithASentence) {
  const auto folder = support::scratch_folder();
  std::ofstream(folder / "noise.png") << "this is no picture at all";
  std::ofstream(folder / "empty.png").close();
  const auto good = write_png("good.png", 64, 64, std::vector<unsigned char>(64 * 64, 9));
  std::ifstream stream(good, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  std::ofstream(folder / "cut.png", std::ios::binary) << bytes.substr(0, bytes.size() / 2);
  write_png("wide.png", 2049, 1, std::vector<unsigned char>(2049, 9));
  for (const char* name : {"noise.png", "empty.png", "cut.png", "wide.png", "none.png"}) {
    const auto image = HeightImage::load(folder / name);
    ASSERT_FALSE(image) << name;
    const bool absent = std::string_view(name) == "none.png";
    EXPECT_NE(image.error().message.find(absent ? "no such file" : "expected a PNG"),
              std::string::npos)
        << image.error().message;
    EXPECT_NE(image.error().message.find(name), std::string::npos);
  }
}

TEST(HeightImage, HasTheSlopeOfItsValueAndNeverLeavesItsPixels) {
  support::Random random(5);
  std::vector<float> values;
  for (int i = 0; i < 7 * 5; ++i) values.push_back(static_cast<float>(random.uniform(0.2, 0.7)));
  const HeightImage image(7, 5, values);
  for (int i = 0; i < 2000; ++i) {
    const double u = random.uniform(-20, 20), v = random.uniform(-20, 20), e = 1e-6;
    const auto here = image.at(u, v);
    EXPECT_NEAR(here.du, (image.at(u + e, v).value - image.at(u - e, v).value) / (2 * e), 1e-8);
    EXPECT_NEAR(here.dv, (image.at(u, v + e).value - image.at(u, v - e).value) / (2 * e), 1e-8);
    EXPECT_GE(here.value, 0.2);
    EXPECT_LE(here.value, 0.7);
    EXPECT_LE(std::hypot(here.du, here.dv), image.slope_max());
    EXPECT_NEAR(image.at(u + 7, v - 5).value, here.value, 1e-12);  // it repeats
  }
  EXPECT_TRUE(std::isnan(image.at(kNan, 0).value));
  EXPECT_TRUE(std::isnan(image.at(0, 1e300).value));
}

template <class Stage>
std::string mistakes_of(VariantSettings reader, EffectContext known = context()) {
  typename Stage::Settings settings;
  settings.read(reader, known);
  return reader.mistakes;
}

VariantSettings::Values wave(double amplitude, double wavelength) {
  return {{"amplitude", amplitude}, {"wavelength", wavelength}};
}

TEST(TextureSettings, PerceptibleOnesAreAccepted) {
  EXPECT_EQ(mistakes_of<Sines>(VariantSettings({}, {{"waves", {wave(0.0001, 0.002)}}})), "");
  EXPECT_EQ(
      mistakes_of<Sines>(VariantSettings(
          {{"form", "depth_only"}}, {{"waves", {{{"amplitude", 0.0001}, {"frequency", 500.0}}}}})),
      "");
  EXPECT_EQ(mistakes_of<Sandpaper>(VariantSettings({})), "");
  const auto flat = write_png("even.png", 8, 8, std::vector<unsigned char>(64, 100));
  EXPECT_EQ(mistakes_of<HeightMap>(
                VariantSettings({{"image", flat.string()}, {"width", 0.01}, {"height", 0.0002}})),
            "");
}

TEST(TextureSettings, AreRefusedWithTheReason) {
  const auto sines = [](const VariantSettings::Values& one) {
    return mistakes_of<Sines>(VariantSettings({}, {{"waves", {one}}}));
  };
  // 5 N press 6.25 mm deep at 800 N/m.
  EXPECT_NE(sines(wave(0.0035, 0.1)).find("is 7 mm from peak to valley"), std::string::npos);
  EXPECT_NE(sines(wave(0.0035, 0.1)).find("5 N press only 6.25 mm deep"), std::string::npos);
  EXPECT_NE(sines(wave(0.001, 0.001)).find("a slope of 6.28"), std::string::npos);
  // 0.1 m/s over 0.15 mm: 667 Hz.
  EXPECT_NE(sines(wave(0.00001, 0.00015)).find("666.7 Hz; a loop of 1000 Hz displays 500 Hz"),
            std::string::npos);
  EXPECT_NE(sines(wave(-0.001, 0.01)).find("amplitude"), std::string::npos);
  EXPECT_NE(sines(wave(kNan, 0.01)).find("amplitude"), std::string::npos);
  EXPECT_NE(sines({{"amplitude", 0.0001}}).find("either wavelength"), std::string::npos);
  EXPECT_NE(sines({{"amplitude", 0.0001}, {"wavelength", 0.01}, {"direction", Vector3d(0, 0, 0)}})
                .find("direction expected a direction"),
            std::string::npos);
  EXPECT_NE(mistakes_of<Sines>(VariantSettings({})).find("waves"), std::string::npos);
  EXPECT_NE(mistakes_of<Sandpaper>(VariantSettings({{"roughness", 0.002}})).find("peak to valley"),
            std::string::npos);
  EXPECT_NE(mistakes_of<Sandpaper>(VariantSettings({{"wavelength", 0.0001}})).find("Hz at most"),
            std::string::npos);
  EXPECT_NE(mistakes_of<Sandpaper>(VariantSettings({{"wavelength", kNan}})).find("wavelength"),
            std::string::npos);
  EXPECT_NE(mistakes_of<HeightMap>(VariantSettings({{"width", 0.01}, {"height", 0.0002}}))
                .find("image is missing"),
            std::string::npos);
  const auto noise = support::scratch_folder() / "noise.png";
  std::ofstream(noise) << "nothing";
  EXPECT_NE(mistakes_of<HeightMap>(
                VariantSettings({{"image", noise.string()}, {"width", 0.01}, {"height", 0.0}}))
                .find("not a readable image"),
            std::string::npos);
}

}  // namespace
}  // namespace thimble::render
