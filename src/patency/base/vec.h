// SPDX-License-Identifier: Apache-2.0
// Three-component vectors and 3x3 matrices of any arithmetic type: double, float or a pack.
// No solvers beyond the closed 3x3 forms; larger systems are Eigen's, in .cpp files.
#pragma once

#include <cmath>

namespace patency {

using Real = double;

template <class T>
struct Vec {
    T x{}, y{}, z{};

    friend constexpr Vec operator+(const Vec& a, const Vec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Vec operator-(const Vec& a, const Vec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend constexpr Vec operator-(const Vec& a) { return {-a.x, -a.y, -a.z}; }
    friend constexpr Vec operator*(const T& s, const Vec& a) { return {s * a.x, s * a.y, s * a.z}; }
    friend constexpr Vec operator*(const Vec& a, const T& s) { return {s * a.x, s * a.y, s * a.z}; }
    friend constexpr Vec operator/(const Vec& a, const T& s) { return {a.x / s, a.y / s, a.z / s}; }
    constexpr Vec& operator+=(const Vec& b) {
        x += b.x;
        y += b.y;
        z += b.z;
        return *this;
    }
    constexpr Vec& operator-=(const Vec& b) {
        x -= b.x;
        y -= b.y;
        z -= b.z;
        return *this;
    }
    constexpr Vec& operator*=(const T& s) {
        x *= s;
        y *= s;
        z *= s;
        return *this;
    }
    friend constexpr bool operator==(const Vec&, const Vec&) = default;
};

template <class T>
constexpr T dot(const Vec<T>& a, const Vec<T>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
constexpr Vec<T> cross(const Vec<T>& a, const Vec<T>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
T norm(const Vec<T>& a) {
    using std::sqrt;
    return sqrt(dot(a, a));
}
/// a / |a|; a must not vanish.
template <class T>
Vec<T> normalized(const Vec<T>& a) {
    return a / norm(a);
}

/// A 3x3 matrix by rows: (row_x, row_y, row_z).
template <class T>
struct Mat {
    Vec<T> x, y, z;

    friend constexpr Mat operator+(const Mat& a, const Mat& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Mat operator-(const Mat& a, const Mat& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend constexpr Mat operator*(const T& s, const Mat& a) { return {s * a.x, s * a.y, s * a.z}; }
    friend constexpr Vec<T> operator*(const Mat& a, const Vec<T>& b) { return {dot(a.x, b), dot(a.y, b), dot(a.z, b)}; }
    friend constexpr Mat operator*(const Mat& a, const Mat& b) {
        const Mat bt = transpose(b);
        return {{dot(a.x, bt.x), dot(a.x, bt.y), dot(a.x, bt.z)},
                {dot(a.y, bt.x), dot(a.y, bt.y), dot(a.y, bt.z)},
                {dot(a.z, bt.x), dot(a.z, bt.y), dot(a.z, bt.z)}};
    }
    constexpr Mat& operator+=(const Mat& b) {
        x += b.x;
        y += b.y;
        z += b.z;
        return *this;
    }
    friend constexpr Mat transpose(const Mat& a) {
        return {{a.x.x, a.y.x, a.z.x}, {a.x.y, a.y.y, a.z.y}, {a.x.z, a.y.z, a.z.z}};
    }
    friend constexpr T trace(const Mat& a) { return a.x.x + a.y.y + a.z.z; }
    friend constexpr T determinant(const Mat& a) { return dot(a.x, cross(a.y, a.z)); }
    friend constexpr bool operator==(const Mat&, const Mat&) = default;
};

/// a : b, the sum of the products of all components.
template <class T>
constexpr T double_dot(const Mat<T>& a, const Mat<T>& b) {
    return dot(a.x, b.x) + dot(a.y, b.y) + dot(a.z, b.z);
}
/// The matrix a b^T.
template <class T>
constexpr Mat<T> outer(const Vec<T>& a, const Vec<T>& b) {
    return {a.x * b, a.y * b, a.z * b};
}
template <class T>
constexpr Mat<T> identity() {
    return {{T(1), T(0), T(0)}, {T(0), T(1), T(0)}, {T(0), T(0), T(1)}};
}
/// The inverse by cofactors; the determinant must not vanish.
template <class T>
constexpr Mat<T> inverse(const Mat<T>& a) {
    const Vec<T> yz = cross(a.y, a.z), zx = cross(a.z, a.x), xy = cross(a.x, a.y);
    return (T(1) / dot(a.x, yz)) * transpose(Mat<T>{yz, zx, xy});
}

using Vec3 = Vec<double>;
using Mat3 = Mat<double>;

/// A unit vector at a right angle to the unit vector n, the same for the same n.
inline Vec3 unit_across(const Vec3& n) {
    const bool is_along_x = n.x >= 0.5 || n.x <= -0.5;
    return normalized(cross(n, is_along_x ? Vec3{0, 1, 0} : Vec3{1, 0, 0}));
}

}   // namespace patency
