#include "thimble/session/run_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "support/seed.h"
#include "thimble/session/run_figures.h"

namespace thimble::session {
namespace {

TEST(Histogram, FindsPercentilesWithinItsBinWidth) {
  std::mt19937_64 random(support::seed_of(7));
  std::uniform_real_distribution<double> exponent(0, std::log(1e10));
  session::Histogram histogram;
  std::vector<std::int64_t> values;
  for (int i = 0; i < 20000; ++i) {
    values.push_back(static_cast<std::int64_t>(std::exp(exponent(random))));
    histogram.add(values.back());
  }
  std::sort(values.begin(), values.end());
  for (const double fraction : {0.0, 0.01, 0.25, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const auto rank = static_cast<std::size_t>(
        std::max(1.0, std::ceil(fraction * static_cast<double>(values.size()))));
    const auto truth = static_cast<double>(values[rank - 1]);
    EXPECT_NEAR(histogram.percentile(fraction), truth, 0.001 * truth) << fraction;
  }
  EXPECT_EQ(histogram.min_ns(), values.front());
  EXPECT_EQ(histogram.max_ns(), values.back());
}

TEST(Histogram, HoldsEachValueInABinNarrowerThanOnePercent) {
  for (std::int64_t value = 1; value < session::Histogram::kMax_ns; value += 1 + value / 37) {
    session::Histogram histogram;
    histogram.add(value);
    ASSERT_EQ(histogram.bins().size(), 1U);
    const session::Histogram::Bin bin = histogram.bins().front();
    EXPECT_LE(bin.lower_ns, value);
    EXPECT_LT(value, bin.upper_ns);
    EXPECT_LE(bin.upper_ns - bin.lower_ns, std::max<std::int64_t>(1, value / 100));
  }
}

TEST(Histogram, ClampsValuesOutOfRange) {
  session::Histogram histogram;
  histogram.add(-5);
  histogram.add(session::Histogram::kMax_ns + 1);
  histogram.add(INT64_MAX);
  EXPECT_EQ(histogram.count(), 3U);
  EXPECT_EQ(histogram.min_ns(), 0);
  EXPECT_EQ(histogram.max_ns(), session::Histogram::kMax_ns);
}

TEST(Histogram, MeanIsTheSumOverTheNumberOfValues) {
  session::Histogram histogram;
  histogram.add(700);
  EXPECT_EQ(histogram.mean_ns(), 700);
  histogram.add(100);
  EXPECT_EQ(histogram.mean_ns(), 400);
}

TEST(Histogram, IsZeroWithoutValues) {
  const session::Histogram histogram;
  EXPECT_EQ(histogram.mean_ns(), 0);
  EXPECT_EQ(histogram.percentile(0.5), 0);
  EXPECT_EQ(histogram.min_ns(), 0);
  EXPECT_EQ(histogram.max_ns(), 0);
}

driver::TickRecord tick(std::int64_t time_ns, bool in_contact) {
  driver::TickRecord record;
  record.time_ns = time_ns;
  record.due_ns = time_ns - 1000;
  record.work_ns = 8000;
  record.in_contact = in_contact;
  record.fresh = true;
  return record;
}

TEST(RunStatistics, CountsTouchDownsAndTimeInContact) {
  session::RunStatistics statistics;
  for (int i = 0; i < 1000; ++i) {
    const bool touching = (i >= 100 && i < 300) || (i >= 500 && i < 600) || (i >= 605 && i < 700);
    statistics.take(tick(i * 1'000'000LL, touching));
  }
  EXPECT_EQ(statistics.contacts(), 3U);
  EXPECT_EQ(statistics.interruptions(), 1U);  // 5 ms without contact do not count as lifting off
  EXPECT_NEAR(statistics.contact_time(), 0.395, 1e-12);
  EXPECT_NEAR(statistics.duration(), 0.999, 1e-12);
  EXPECT_NEAR(statistics.rate(), 1000, 1e-9);
  EXPECT_EQ(statistics.ticks(), 1000U);
}

TEST(RunStatistics, CountsAContactFromTheFirstTickOn) {
  session::RunStatistics statistics;
  statistics.take(tick(0, true));
  statistics.take(tick(1'000'000, true));
  EXPECT_EQ(statistics.contacts(), 1U);
  EXPECT_EQ(statistics.interruptions(), 0U);
}

TEST(RunStatistics, EnergyUsesTheForceThatActedInEachStep) {
  // f = (1, 2, 0) N in tick 0 acts while the tip moves by (3, 4, 5) mm: 11 mJ to the hand; the
  // force of tick 1 acts while it moves back by half: -(1.5 * 4) mJ.
  session::RunStatistics statistics;
  driver::TickRecord record = tick(0, true);
  record.f_sent_W = {1, 2, 0};
  statistics.take(record);
  record.time_ns = 1'000'000;
  record.p_WT = {0.003, 0.004, 0.005};
  record.f_sent_W = {4, 0, 0};
  statistics.take(record);
  EXPECT_NEAR(statistics.energy_to_hand(), 0.011, 1e-15);
  record.time_ns = 2'000'000;
  record.p_WT = {0.0015, 0.004, 0.005};
  record.f_sent_W = {100, 100, 100};  // acts after the last tick: not counted
  statistics.take(record);
  EXPECT_NEAR(statistics.energy_to_hand(), 0.005, 1e-15);
  EXPECT_NEAR(statistics.energy_to_hand_max(), 0.011, 1e-15);
}

TEST(RunStatistics, AgreesWithPlainSumsOverRandomRecords) {
  std::mt19937_64 random(support::seed_of(11));
  std::normal_distribution<double> normal;
  session::RunStatistics statistics;
  double force_max = 0, squares = 0, squares_of_all = 0, depth_max = 0, energy = 0;
  std::uint64_t touching = 0, missing = 0;
  driver::TickRecord last;
  for (int i = 0; i < 5000; ++i) {
    driver::TickRecord record = tick(i * 1'000'000LL, random() % 3 != 0);
    record.fresh = random() % 50 != 0;
    for (std::size_t k = 0; k < 3; ++k) {
      record.f_sent_W[k] = normal(random);
      record.p_WT[k] = 1e-3 * normal(random);
      if (i > 0) energy += last.f_sent_W[k] * (record.p_WT[k] - last.p_WT[k]);
    }
    record.depth = record.in_contact ? std::abs(1e-3 * normal(random)) : 0;
    const double force = std::hypot(record.f_sent_W[0], record.f_sent_W[1], record.f_sent_W[2]);
    force_max = std::max(force_max, force);
    depth_max = std::max(depth_max, record.depth);
    if (record.in_contact) squares += force * force;
    squares_of_all += force * force;
    touching += record.in_contact ? 1 : 0;
    missing += record.fresh ? 0 : 1;
    statistics.take(record);
    last = record;
  }
  EXPECT_NEAR(statistics.force_max(), force_max, 1e-12);
  EXPECT_NEAR(statistics.force_rms(), std::sqrt(squares / static_cast<double>(touching)), 1e-9);
  EXPECT_NEAR(statistics.force_rms_of_run(), std::sqrt(squares_of_all / 5000), 1e-9);
  EXPECT_EQ(statistics.depth_max(), depth_max);
  EXPECT_NEAR(statistics.energy_to_hand(), energy, 1e-9);
  EXPECT_EQ(statistics.missing_reports(), missing);
}

TEST(RunStatistics, KeepsTheFirstFault) {
  session::RunStatistics statistics;
  driver::TickRecord record = tick(0, false);
  statistics.take(record);
  record.fault = driver::Fault::kOverSpeed;
  statistics.take(record);
  record.fault = driver::Fault::kTransportLost;
  statistics.take(record);
  EXPECT_EQ(statistics.fault_ticks(), 2U);
  EXPECT_EQ(statistics.first_fault(), driver::Fault::kOverSpeed);
}

TEST(RunFigures, ReportPeriodsInMicroseconds) {
  session::RunFigures report;
  report.statistics.take(tick(1'000'000, false));
  report.statistics.take(tick(3'500'000, false));
  for (const session::Figure& figure : session::figures_of(report)) {
    if (figure.name != "period_max") continue;
    EXPECT_EQ(figure.value, 2500);
    EXPECT_EQ(figure.unit, "us");
    return;
  }
  ADD_FAILURE() << "there is no period_max";
}

}  // namespace
}  // namespace thimble::session
