// Base of laws whose forces and tangents come from kernels, eight elements (or faces) at a time.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "mechanics/kernels/element_chunks.hpp"
#include "mechanics/kernels/kernels.hpp"
#include "mechanics/kernels/tables.hpp"
#include "mechanics/law.hpp"

namespace plica {

/// Law of elements of that many corners. `Self` has `tables` (its kernels by instruction set), kernel_arrays(step)
/// (their input) and, if rest shapes grow, fit(tissue, place): element data from the rest shape. There are places for
/// whole batches, since kernels calculate in them; those after the last element repeat it.
template <class Self, int corners>
class BatchLaw : public Law {
 public:
  using Nodes = std::array<NodeId, corners>;
  static constexpr std::size_t batch_size = ElementChunks::batch_size;

  [[nodiscard]] std::unique_ptr<Law> clone() const final { return std::make_unique<Self>(self()); }
  void add_forces(const Step& step, std::span<Vec3> forces) const final {
    const auto& at = self().kernel_arrays(step);
    chunks_.for_batches(
        [&](std::size_t first, std::size_t last) { kernels().add_forces(at, first, last, components(forces)); });
  }
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const final {
    const auto& at = self().kernel_arrays(step);
    chunks_.for_batches([&](std::size_t first, std::size_t last) {
      kernels().add_product(at, first, last, components(direction), components(product));
    });
  }
  void add_tangent(const Step& step, TangentSink& tangent) const override {
    const auto& at = self().kernel_arrays(step);
    const auto add_batch = [&](std::size_t batch) {
      TangentBlocks<corners> of_batch;
      kernels().write_blocks(at, batch, of_batch);
      const std::size_t first = batch * batch_size;
      for (std::size_t e = first; e < std::min(first + batch_size, elements_.size()); ++e)
        for (int i = 0, pair = 0; i < corners; ++i)
          for (int j = 0; j <= i; ++j, ++pair) {
            Mat3 block;
            for (int k = 0; k < 9; ++k) block.data()[k] = of_batch.blocks[pair][k][e - first];
            tangent.add_block(elements_[e][i], elements_[e][j], block);
          }
    };
    chunks_.for_batches(
        [&](std::size_t first, std::size_t last) {
          for (std::size_t batch = first; batch < last; ++batch) add_batch(batch);
        },
        tangent.accepts_concurrent_blocks());
  }
  [[nodiscard]] NodeGroups node_groups(std::span<const double> /*internal*/) const final {
    NodeGroups groups;
    for (const Nodes& nodes : elements_) groups.add(nodes);
    return groups;
  }

 protected:
  BatchLaw(std::vector<Nodes> elements, ElementChunks chunks, Kernels kernels)
      : elements_(std::move(elements)), chunks_(std::move(chunks)), kernels_(kernels) {}

  [[nodiscard]] const auto& kernels() const { return *Self::tables[static_cast<std::size_t>(kernels_)]; }
  [[nodiscard]] std::size_t places() const { return batch_size * chunks_.batch_count(); }

  std::vector<Nodes> elements_;
  ElementChunks chunks_;
  Kernels kernels_;

 private:
  [[nodiscard]] const Self& self() const { return static_cast<const Self&>(*this); }
};

}  // namespace plica
