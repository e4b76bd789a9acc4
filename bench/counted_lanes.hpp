// Number that counts operations, in place of the SIMD lanes of kernel sources. Include it before such a source, which
// is then compiled again for one element at a time.
#pragma once

#define PLICA_KERNELS counted
#define PLICA_LANES 1

namespace plica::counted {

/// Additions, subtractions, multiplications and divisions so far on this thread; a fused multiply-add counts as two.
inline thread_local long operations = 0;

struct Mask {
  long long value;
  long long operator[](int) const { return value; }
  Mask operator&(Mask other) const { return {value & other.value}; }
  Mask operator~() const { return {~value}; }
};

struct Lanes {
  double value = 0;
  Lanes() = default;
  Lanes(double v) : value(v) {}  // NOLINT: as doubles among vectors
  double& operator[](int) { return value; }
  double operator[](int) const { return value; }
  Lanes operator-() const { return -value; }
  Lanes& operator+=(Lanes other) { return *this = *this + other; }
  Lanes& operator-=(Lanes other) { return *this = *this - other; }
  friend Lanes operator+(Lanes a, Lanes b) { return ++operations, Lanes(a.value + b.value); }
  friend Lanes operator-(Lanes a, Lanes b) { return ++operations, Lanes(a.value - b.value); }
  friend Lanes operator*(Lanes a, Lanes b) { return ++operations, Lanes(a.value * b.value); }
  friend Lanes operator/(Lanes a, Lanes b) { return ++operations, Lanes(a.value / b.value); }
  friend Mask operator>(Lanes a, Lanes b) { return {a.value > b.value ? -1 : 0}; }
};
inline Lanes broadcast(double value) { return value; }

}  // namespace plica::counted
