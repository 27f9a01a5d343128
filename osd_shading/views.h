// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

namespace osd_shading {
inline namespace v1 {

/// Read-only view over contiguous memory of the caller. Never owns; the memory must outlive the view.
template <typename T>
class ArrayView {
public:
    constexpr ArrayView() = default;

    /// `size` elements at `data`; `data` may be null only when `size` is 0 (checked where it is used).
    constexpr ArrayView(T const* data, std::size_t size) : _data(data), _size(size) {}

    /// Any contiguous container with `data()` and `size()` (std::vector, std::array, std::span).
    template <typename Container, typename = std::enable_if_t<std::is_convertible_v<
                                      decltype(std::declval<Container const&>().data()), T const*>>>
    constexpr ArrayView(Container const& container)  // implicit, as std::span
        : _data(container.data()), _size(container.size()) {}

    /// \name As std::span
    /// @{

    /// Indices are not checked.
    constexpr T const* data() const { return _data; }
    constexpr std::size_t size() const { return _size; }
    constexpr bool empty() const { return _size == 0; }
    constexpr T const& operator[](std::size_t i) const { return _data[i]; }
    constexpr T const* begin() const { return _data; }
    constexpr T const* end() const { return _data + _size; }
    /// @}

private:
    T const* _data = nullptr;
    std::size_t _size = 0;
};

/// A point or direction of three components; contiguous and without padding.
template <typename Real>
struct Vec3 {
    Real x = 0;  ///< the first
    Real y = 0;  ///< the second
    Real z = 0;  ///< the third
};

/// Read-only view over `count` elements of `width` consecutive `Real`s, element i at `data + i * stride`.
///
/// `stride` counts `Real`s, not bytes, and is at least `width`. Never owns.
template <typename Real>
class PrimvarView {
public:
    constexpr PrimvarView() = default;
    /// `count` elements, each `width` numbers, `stride` numbers from one to the next.
    constexpr PrimvarView(Real const* data, std::size_t count, int width, std::size_t stride)
        : _data(data), _count(count), _stride(stride), _width(width) {}
    /// The same, packed.
    constexpr PrimvarView(Real const* data, std::size_t count, int width)
        : PrimvarView(data, count, width, static_cast<std::size_t>(width)) {}

    /// \name What it was made of
    /// @{

    /// `size` counts elements; element i is `width` numbers. Indices are not checked.
    constexpr Real const* data() const { return _data; }
    constexpr std::size_t size() const { return _count; }
    constexpr bool empty() const { return _count == 0; }
    constexpr int width() const { return _width; }
    constexpr std::size_t stride() const { return _stride; }
    constexpr Real const* operator[](std::size_t i) const { return _data + i * _stride; }
    /// @}

private:
    Real const* _data = nullptr;
    std::size_t _count = 0, _stride = 0;
    int _width = 0;
};

/// Read-only view over points: x, y, z of point i at `data + i * stride` (`stride` in `Real`s, at least 3).
///
/// A stride of 4 reads padded points, a larger one interleaved vertex buffers, without a copy.
template <typename Real>
class PointView {
public:
    constexpr PointView() = default;
    /// `count` points, `stride` numbers from one to the next.
    constexpr PointView(Real const* data, std::size_t count, std::size_t stride = 3)
        : _data(data), _count(count), _stride(stride) {}
    /// Implicit: a packed array of points, which must outlive the view.
    PointView(std::vector<Vec3<Real>> const& points)
        : _data(points.empty() ? nullptr : &points[0].x), _count(points.size()), _stride(3) {}

    /// \name What it was made of
    /// @{

    /// `size` counts points. Indices are not checked.
    constexpr Real const* data() const { return _data; }
    constexpr std::size_t size() const { return _count; }
    constexpr bool empty() const { return _count == 0; }
    constexpr std::size_t stride() const { return _stride; }
    constexpr Vec3<Real> operator[](std::size_t i) const {
        Real const* p = _data + i * _stride;
        return {p[0], p[1], p[2]};
    }
    /// @}

private:
    Real const* _data = nullptr;
    std::size_t _count = 0, _stride = 3;
};

}  // namespace v1
}  // namespace osd_shading
