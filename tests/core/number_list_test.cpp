// Values as numbers and back.
#include "core/number_list.hpp"

#include <map>

#include "support/tissues.hpp"

namespace {

struct Leaf {
  NodeId node;
  std::optional<double> length;
  std::array<bool, 2> held = {false, false};

  bool operator==(const Leaf&) const = default;
  static auto parts(auto& leaf) { return std::tie(leaf.node, leaf.length, leaf.held); }
};

struct Tree {
  std::vector<std::vector<Leaf>> branches;
  std::map<std::string, Vec3> places;
  std::shared_ptr<const Leaf> top;
  char mark = 0;

  static auto parts(auto& tree) { return std::tie(tree.branches, tree.places, tree.top, tree.mark); }
};

TEST(NumberList, ValuesComeBack) {
  const Leaf leaf{NodeId(7), 0.1, {true, false}};
  const Tree tree{
      {{leaf, {}}, {}, {leaf}}, {{"a", Vec3(1, 2, 3)}, {"", Vec3(4, 5, 6)}}, std::make_shared<const Leaf>(leaf), -3};
  Tree again;
  again.branches.resize(9);
  take_numbers(as_numbers(tree), again);
  EXPECT_EQ(again.branches, tree.branches);
  EXPECT_EQ(again.places, tree.places);
  EXPECT_EQ(*again.top, leaf);
  EXPECT_EQ(again.mark, tree.mark);
  take_numbers(as_numbers(Tree()), again);
  EXPECT_TRUE(again.branches.empty());
  EXPECT_FALSE(again.top);
}

TEST(NumberList, OtherNumbersAreRefused) {
  const auto is_refused = [](const std::vector<double>& numbers, auto value) {
    try {
      take_numbers(numbers, value);
      return false;
    } catch (const InvalidNumbers&) {
      return true;
    }
  };
  EXPECT_FALSE(is_refused({2, 1, 2}, std::vector<int>()));
  for (const std::vector<double>& numbers :
       {std::vector<double>{}, {2, 1}, {2, 1, 2, 3}, {3, 1, 2}, {-1}, {0.5, 1}, {1e300}, {1, 0.5}, {1, 1e10}})
    EXPECT_TRUE(is_refused(numbers, std::vector<int>())) << numbers.size();
  EXPECT_TRUE(is_refused({2, 1}, std::optional<double>()));
  EXPECT_TRUE(is_refused({1e10}, NodeId()));
  EXPECT_TRUE(is_refused({1}, Vec3()));
}

}  // namespace
