#include "view/start/card_grid.h"

#include <gtest/gtest.h>

namespace thimble::view {
namespace {

TEST(CardGrid, FillsTheWidthWithWholeColumns) {
  const CardGrid grid = fit_cards(1000, 180, 10);
  EXPECT_EQ(grid.columns, 5u);
  EXPECT_EQ(grid.width, 192);
}

TEST(CardGrid, HasAColumnHoweverNarrowThePageIs) {
  EXPECT_EQ(fit_cards(100, 180, 10).columns, 1u);
  EXPECT_EQ(fit_cards(0, 180, 10).columns, 1u);
  EXPECT_GE(fit_cards(-5, 180, 10).width, 1);
}

TEST(CardGrid, ArrowsMoveWithinAGroup) {
  const std::vector<std::size_t> sizes = {7};
  EXPECT_EQ(moved({0, 0}, 1, 0, 3, sizes), (CardPlace{0, 1}));
  EXPECT_EQ(moved({0, 1}, -1, 0, 3, sizes), (CardPlace{0, 0}));
  EXPECT_EQ(moved({0, 1}, 0, 1, 3, sizes), (CardPlace{0, 4}));
  EXPECT_EQ(moved({0, 4}, 0, -1, 3, sizes), (CardPlace{0, 1}));
}

TEST(CardGrid, DownLeadsToTheLastCardOfAShorterRow) {
  EXPECT_EQ(moved({0, 5}, 0, 1, 3, {7}), (CardPlace{0, 6}));
}

TEST(CardGrid, UpAndDownCrossGroups) {
  const std::vector<std::size_t> sizes = {5, 2};
  EXPECT_EQ(moved({0, 4}, 0, 1, 3, sizes), (CardPlace{1, 1}));
  EXPECT_EQ(moved({0, 3}, 0, 1, 3, sizes), (CardPlace{1, 0}));
  EXPECT_EQ(moved({1, 1}, 0, -1, 3, sizes), (CardPlace{0, 4}));
}

TEST(CardGrid, ArrowsStayAtTheEnds) {
  const std::vector<std::size_t> sizes = {4};
  EXPECT_EQ(moved({0, 0}, -1, 0, 3, sizes), (CardPlace{0, 0}));
  EXPECT_EQ(moved({0, 0}, 0, -1, 3, sizes), (CardPlace{0, 0}));
  EXPECT_EQ(moved({0, 3}, 1, 0, 3, sizes), (CardPlace{0, 3}));
  EXPECT_EQ(moved({0, 3}, 0, 1, 3, sizes), (CardPlace{0, 3}));
  EXPECT_EQ(moved({2, 9}, 1, 1, 3, sizes), (CardPlace{2, 9})) << "there is no such group";
}

}  // namespace
}  // namespace thimble::view
