// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/patchKernelSets.h"
#include "osd_shading/tables/patchKernelsImpl.h"

#include <cmath>

namespace osd_shading {
inline namespace v1 {

namespace {

// Four numbers in plain loops, which compilers turn into vectors where there are some.
struct Vector {
    float v[4];

    static Vector Load(float const* p) { return {{p[0], p[1], p[2], p[3]}}; }
    static Vector Broadcast(float const* p) { return Set(*p); }
    static Vector Set(float x) { return {{x, x, x, x}}; }
    Vector Kept() const { return *this; }
    void Store(float* p) const {
        for (int i = 0; i < 4; ++i) p[i] = v[i];
    }
};

struct Mask {
    bool v[4];
};

template <typename Function>
Vector eachLane(Function const& f) {
    return {{f(0), f(1), f(2), f(3)}};
}

Vector operator+(Vector a, Vector b) {
    return eachLane([&](int i) { return a.v[i] + b.v[i]; });
}
Vector operator-(Vector a, Vector b) {
    return eachLane([&](int i) { return a.v[i] - b.v[i]; });
}
Vector operator*(Vector a, Vector b) {
    return eachLane([&](int i) { return a.v[i] * b.v[i]; });
}
Vector operator/(Vector a, Vector b) {
    return eachLane([&](int i) { return a.v[i] / b.v[i]; });
}
Vector MulAdd(Vector a, Vector b, Vector c) { return a * b + c; }
Vector MulSub(Vector a, Vector b, Vector c) { return a * b - c; }
Vector Sqrt(Vector a) {
    return eachLane([&](int i) { return std::sqrt(a.v[i]); });
}
Vector Max(Vector a, Vector b) {
    return eachLane([&](int i) { return a.v[i] > b.v[i] ? a.v[i] : b.v[i]; });
}

Mask Greater(Vector a, Vector b) { return {{a.v[0] > b.v[0], a.v[1] > b.v[1], a.v[2] > b.v[2], a.v[3] > b.v[3]}}; }
Mask NotLess(Vector a, Vector b) {
    return {{a.v[0] >= b.v[0], a.v[1] >= b.v[1], a.v[2] >= b.v[2], a.v[3] >= b.v[3]}};
}
Mask And(Mask a, Mask b) { return {{a.v[0] && b.v[0], a.v[1] && b.v[1], a.v[2] && b.v[2], a.v[3] && b.v[3]}}; }
unsigned Bits(Mask m) {
    return unsigned(m.v[0]) | unsigned(m.v[1]) << 1 | unsigned(m.v[2]) << 2 | unsigned(m.v[3]) << 3;
}
Vector Select(Mask m, Vector a, Vector b) {
    return eachLane([&](int i) { return m.v[i] ? a.v[i] : b.v[i]; });
}
Vector KeepIf(Mask m, Vector a) { return Select(m, a, Vector::Set(0)); }

Vector ZipLow(Vector a, Vector b) { return {{a.v[0], b.v[0], a.v[1], b.v[1]}}; }
Vector ZipHigh(Vector a, Vector b) { return {{a.v[2], b.v[2], a.v[3], b.v[3]}}; }
void Transpose(Vector& a, Vector& b, Vector& c, Vector& d) {
    Vector const rows[4] = {a, b, c, d};
    Vector* const columns[4] = {&a, &b, &c, &d};
    for (int i = 0; i < 4; ++i) {
        *columns[i] = eachLane([&](int j) { return rows[j].v[i]; });
    }
}

struct PortableLanes {
    using Vector = v1::Vector;
    using Quad = v1::Vector;
    static constexpr int kCount = 4;

    template <int kSide>
    static Vector Repeat(float const* p) {
        return Vector::Load(p);
    }
    template <int kSide>
    static Vector Spread(float const* p) {
        return Vector::Broadcast(p);
    }

    static void WritePacked(Vector x, Vector y, Vector z, float* to) { WriteStrided(x, y, z, to, 3); }
    static void WriteStrided(Vector x, Vector y, Vector z, float* to, std::size_t stride) {
        for (int i = 0; i < 4; ++i, to += stride) {
            to[0] = x.v[i];
            to[1] = y.v[i];
            to[2] = z.v[i];
        }
    }
};

}  // namespace

constinit PatchKernels const kPortableKernels = KernelsFor<PortableLanes>::Table("portable");

}  // namespace v1
}  // namespace osd_shading
