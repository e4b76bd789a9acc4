// Which contacts change: freely, one in a neighbourhood, one in all.
#include "solver/step/obstacle_changes.hpp"

#include "mechanics/obstacles/vitelline.hpp"
#include "support/models.hpp"

namespace {

/// A shell of 10 x 10 cells a side, all contacts of which want to join their obstacle.
struct Shell {
  Shell() : model(build_shell({.length_um = 350, .diameter_um = 350, .cells = {10, 10, 10}})) {
    model.obstacles.push_back(std::make_unique<Vitelline>(model.tissue, *model.tissue.outer_shape));
    contacts.emplace(model);
    rule.emplace(model.tissue, *contacts);
    on_obstacle.assign(contacts->size(), 0);
    changes.assign(contacts->size(), 0);
    cells_of_node.resize(model.tissue.node_count());
    for (std::size_t e = 0; e < model.tissue.elements.size(); ++e)
      for (const NodeId node : model.tissue.elements[e])
        cells_of_node[node.index()].insert(model.tissue.element_cell[e]);
  }
  /// Revise once; the contacts that changed.
  std::vector<std::size_t> changed(const std::vector<char>& wanted) {
    const std::vector<char> before = on_obstacle;
    rule->make(wanted, changes, on_obstacle);
    std::vector<std::size_t> result;
    for (std::size_t k = 0; k < before.size(); ++k)
      if (on_obstacle[k] != before[k]) result.push_back(k);
    return result;
  }
  [[nodiscard]] bool share_a_cell(std::size_t a, std::size_t b) const {
    return std::ranges::any_of(cells_of_node[contacts->node(a).index()],
                               [&](CellId cell) { return cells_of_node[contacts->node(b).index()].contains(cell); });
  }

  Model model;
  std::optional<ObstacleContacts> contacts;
  std::optional<ObstacleChanges> rule;
  std::vector<char> on_obstacle;
  std::vector<unsigned char> changes;
  std::vector<std::set<CellId>> cells_of_node;
};

TEST(ObstacleChanges, AllChangeAtOnceAtFirst) {
  Shell shell;
  const std::size_t all = shell.contacts->size();
  ASSERT_GT(all, 500u);
  for (const char to : {1, 0, 1}) EXPECT_EQ(shell.changed(std::vector<char>(all, to)).size(), all);
  EXPECT_EQ(shell.changes, std::vector<unsigned char>(all, ObstacleChanges::freely));
  EXPECT_TRUE(shell.changed(std::vector<char>(all, 1)).empty()) << "they are as they are wanted";
}

TEST(ObstacleChanges, ThenOneInANeighbourhoodAndAsManyOfThemAsThereIsRoomFor) {
  Shell shell;
  const std::size_t all = shell.contacts->size();
  std::ranges::fill(shell.changes, ObstacleChanges::freely);
  const std::vector<char> wanted(all, 1);
  std::size_t revisions = 0;
  while (std::ranges::count(shell.on_obstacle, 1) < static_cast<std::ptrdiff_t>(all)) {
    const std::vector<char> before = shell.on_obstacle;
    const std::vector<std::size_t> changed = shell.changed(wanted);
    ASSERT_FALSE(changed.empty());
    for (const std::size_t a : changed)
      for (const std::size_t b : changed) EXPECT_TRUE(a == b || !shell.share_a_cell(a, b));
    for (std::size_t k = 0; k < all; ++k)
      EXPECT_TRUE(before[k] == 1 ||
                  std::ranges::any_of(changed, [&](std::size_t a) { return shell.share_a_cell(a, k); }))
          << "nothing kept contact " << k << " from changing";
    ASSERT_LT(++revisions, 30u) << "as many as nodes that share cells, however large the tissue";
  }
}

TEST(ObstacleChanges, ThoseThatWaitLetNeighboursChangeFreely) {
  Shell shell;
  const std::size_t all = shell.contacts->size();
  std::ranges::fill(shell.changes, ObstacleChanges::freely);
  shell.changes[all - 1] = 0;
  const std::vector<std::size_t> changed = shell.changed(std::vector<char>(all, 1));
  EXPECT_TRUE(std::ranges::count(changed, all - 1));
  EXPECT_GT(changed.size(), all / 30) << "it hinders its neighbours only";
  for (const std::size_t k : changed) EXPECT_TRUE(k == all - 1 || !shell.share_a_cell(k, all - 1));
}

TEST(ObstacleChanges, AtLastTheFirstOfAll) {
  Shell shell;
  const std::size_t all = shell.contacts->size();
  std::ranges::fill(shell.changes, ObstacleChanges::locally);
  EXPECT_EQ(shell.changed(std::vector<char>(all, 1)), std::vector<std::size_t>{0});
  EXPECT_EQ(shell.changed(std::vector<char>(all, 1)), std::vector<std::size_t>{1});
  EXPECT_EQ(shell.changes[1], ObstacleChanges::locally);
}

// However contacts answer each other, each is asked only so often before the rule that ends.
TEST(ObstacleChanges, EndsInTheRuleOfOneAtATime) {
  Shell shell;
  const std::size_t all = shell.contacts->size();
  std::vector<char> wanted(all);
  int revisions = 0;
  do {
    for (std::size_t k = 0; k < all; ++k) wanted[k] = !shell.on_obstacle[k];
    ASSERT_LT(++revisions, 1000);
  } while (shell.changed(wanted) != std::vector<std::size_t>{0});
  EXPECT_EQ(shell.changes, std::vector<unsigned char>(all, ObstacleChanges::locally));
}

}  // namespace
