#define PLICA_KERNELS counted
#define PLICA_LANES 1
#include "counted_kernels.hpp"

namespace plica::counted {
namespace {

thread_local long count = 0;

struct Mask {
  long long value;
  long long operator[](int) const { return value; }
  Mask& operator&=(Mask other) { return value &= other.value, *this; }
  Mask operator&(Mask other) const { return {value & other.value}; }
  Mask operator~() const { return {~value}; }
};

}  // namespace

struct Lanes {
  double value = 0;
  Lanes() = default;
  Lanes(double v) : value(v) {}  // NOLINT: as doubles among vectors
  double& operator[](int) { return value; }
  double operator[](int) const { return value; }
  Lanes operator-() const { return -value; }
  Lanes& operator+=(Lanes other) { return *this = value + other.value, ++count, *this; }
  Lanes& operator-=(Lanes other) { return *this = value - other.value, ++count, *this; }
  friend Lanes operator+(Lanes a, Lanes b) { return ++count, Lanes(a.value + b.value); }
  friend Lanes operator-(Lanes a, Lanes b) { return ++count, Lanes(a.value - b.value); }
  friend Lanes operator*(Lanes a, Lanes b) { return ++count, Lanes(a.value * b.value); }
  friend Lanes operator/(Lanes a, Lanes b) { return ++count, Lanes(a.value / b.value); }
  friend Mask operator==(Lanes a, Lanes b) { return {a.value == b.value ? -1 : 0}; }
  friend Mask operator>(Lanes a, Lanes b) { return {a.value > b.value ? -1 : 0}; }
};
inline Lanes broadcast(double value) { return value; }

}  // namespace plica::counted

#include "mechanics/kernels/corotational_blocks_kernels.cpp"
#include "mechanics/kernels/corotational_kernels.cpp"

namespace plica::counted {

const CorotationalKernels& corotational() { return corotational_kernels; }

long take_count() {
  const long counted = count;
  count = 0;
  return counted;
}

}  // namespace plica::counted
