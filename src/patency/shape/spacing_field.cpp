// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/spacing_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "patency/base/errors.h"
#include "patency/base/parallel.h"

namespace patency {

namespace {

using Ball = InscribedBall;

constexpr double ball_precision = 0.01;   // how near to the ridge of the distance a ball's centre is found, in radii
constexpr double ball_step = 0.2;         // balls nearer to a larger one are left out, in radii: holds 99.5 % of a tube

/// Looks for the largest balls by halving cubes until they are small against the depth of their middle.
class BallSearch {
public:
    BallSearch(const SignedDistance& distance, double least) : distance_(distance), least_(least) {}

    void add(const Vec3& middle, double half, std::vector<Ball>& found) const {
        const DistanceSample here = distance_.sample(middle);
        const double depth = -here.value, reach = std::sqrt(3.0) * half;
        if (depth + reach < least_) return;   // a distance changes by at most the length of the way
        if (2 * half > std::max(depth / 3, least_ / 2)) {
            const double q = 0.5 * half;
            for (int k = 0; k < 8; ++k) add(middle + Vec3{k & 1 ? q : -q, k & 2 ? q : -q, k & 4 ? q : -q}, q, found);
            return;
        }
        // Away from a ridge the depth grows as fast as the way.
        const double way = 2 * reach;
        if (depth < least_ || -distance_.value(middle - way * here.gradient) > depth + 0.95 * way) return;
        found.push_back(climb(middle, here, way));
    }

private:
    /// To the ridge; not along it, where the depth grows by less than half of the way.
    Ball climb(Vec3 x, DistanceSample here, double step) const {
        while (step > ball_precision * -here.value) {
            const Vec3 next = x - step * here.gradient;
            const DistanceSample there = distance_.sample(next);
            if (here.value - there.value > 0.5 * step)
                x = next, here = there;
            else
                step *= 0.5;
        }
        return {x, -here.value};
    }

    const SignedDistance& distance_;
    double least_;
};

std::vector<Ball> find_balls(const Lumen& lumen, double least) {
    const Vec3 size = lumen.bounds.high - lumen.bounds.low;
    const double side = std::max({size.x, size.y, size.z}) / 16;
    const auto count = [&](double length) { return std::max<std::size_t>(1, std::size_t(std::ceil(length / side))); };
    const std::size_t nx = count(size.x), ny = count(size.y), nz = count(size.z);
    std::vector<std::vector<Ball>> found(nx * ny * nz);
    const BallSearch search(lumen.distance, least);
    for_each_task(found.size(), [&](std::size_t n) {
        const std::size_t i = n / (ny * nz), j = n / nz % ny, k = n % nz;
        search.add(lumen.bounds.low + side * Vec3{double(i) + 0.5, double(j) + 0.5, double(k) + 0.5}, 0.5 * side,
                   found[n]);
    });
    std::vector<Ball> all;
    for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
    return all;
}

/// From the largest to the smallest, and one ball of those of about one size with their centres in one cube.
std::vector<Ball> thinned(std::vector<Ball> all, double least, const Vec3& origin) {
    const auto key = [](const Ball& b) { return std::tuple(-b.radius, b.centre.x, b.centre.y, b.centre.z); };
    std::sort(all.begin(), all.end(), [&](const Ball& a, const Ball& b) { return key(a) < key(b); });
    std::vector<Ball> kept;
    std::set<std::array<long, 4>> taken;
    for (const Ball& ball : all) {
        const double octave = std::ceil(2 * std::log2(ball.radius / least)),
                     cube = ball_step * least * std::exp2(octave / 2);
        const Vec3 at = (ball.centre - origin) / cube;
        if (taken.insert({long(std::floor(at.x)), long(std::floor(at.y)), long(std::floor(at.z)), long(octave)}).second)
            kept.push_back(ball);
    }
    return kept;
}

}   // namespace

/// Nodes in bricks around the balls.
class SpacingField::Grid {
public:
    Grid(const std::vector<Ball>& balls, double step, const SpacingSettings& settings);

    double at(const Vec3& x, double nowhere) const {
        const Vec3 place = (x - origin_) / step_;
        constexpr double most = 1e8;
        if (!(std::abs(place.x) < most && std::abs(place.y) < most && std::abs(place.z) < most)) return nowhere;
        const double fi = std::floor(place.x), fj = std::floor(place.y), fk = std::floor(place.z);
        const double u = place.x - fi, v = place.y - fj, w = place.z - fk;
        double sum = 0;
        for (int n = 0; n < 8; ++n) {
            const int a = n >> 2, b = (n >> 1) & 1, c = n & 1;
            const float* node = find(int(fi) + a, int(fj) + b, int(fk) + c);
            sum += (a ? u : 1 - u) * (b ? v : 1 - v) * (c ? w : 1 - w) * (node ? double(*node) : nowhere);
        }
        return sum;
    }

private:
    static constexpr int size = 8, cells = size * size * size;
    static constexpr float empty = 1e30f;

    const float* find(int i, int j, int k) const {
        const int bi = i >> 3, bj = j >> 3, bk = k >> 3;
        if (bi < 0 || bj < 0 || bk < 0 || bi >= count_[0] || bj >= count_[1] || bk >= count_[2]) return nullptr;
        const int brick = table_[(std::size_t(bi) * count_[1] + bj) * count_[2] + bk];
        return brick < 0 ? nullptr : &nodes_[std::size_t(brick) * cells + (((i & 7) << 6) | ((j & 7) << 3) | (k & 7))];
    }
    float* find(int i, int j, int k) { return const_cast<float*>(std::as_const(*this).find(i, j, k)); }
    std::array<int, 3> node_at(const Vec3& x) const {
        const Vec3 place = (x - origin_) / step_;
        return {int(std::floor(place.x)), int(std::floor(place.y)), int(std::floor(place.z))};
    }
    void limit_growth(double growth);

    Vec3 origin_;
    double step_;
    int count_[3];
    std::vector<int> table_;
    std::vector<std::array<int, 3>> first_;   // node of each brick
    std::vector<float> nodes_;
};

SpacingField::Grid::Grid(const std::vector<Ball>& balls, double step, const SpacingSettings& settings) : step_(step) {
    // The corner of a cube is 1.73 radii away from its middle.
    const auto box_of = [](const Ball& ball, double reach) {
        return grown({ball.centre, ball.centre}, reach * ball.radius);
    };
    constexpr double around = 1.8;
    Bounds box = box_of(balls[0], around);
    for (const Ball& ball : balls) box = joined(box, box_of(ball, around));
    origin_ = box.low;
    const std::array<int, 3> last = node_at(box.high);
    for (std::size_t axis = 0; axis < 3; ++axis) count_[axis] = (last[axis] >> 3) + 1;
    table_.assign(std::size_t(count_[0]) * count_[1] * count_[2], -1);
    for (const Ball& ball : balls) {
        const Bounds own = box_of(ball, around);
        const auto low = node_at(own.low), high = node_at(own.high);
        for (int i = low[0] >> 3; i <= high[0] >> 3; ++i)
            for (int j = low[1] >> 3; j <= high[1] >> 3; ++j)
                for (int k = low[2] >> 3; k <= high[2] >> 3; ++k) {
                    int& brick = table_[(std::size_t(i) * count_[1] + j) * count_[2] + k];
                    if (brick >= 0) continue;
                    brick = int(first_.size());
                    first_.push_back({i * size, j * size, k * size});
                }
    }
    nodes_.assign(first_.size() * cells, empty);
    // Around the balls, from the largest to the smallest: voxels across the wall. In them, from the smallest to the largest.
    const auto paint = [&](const Ball& ball, double radius) {
        const Bounds own = grown({ball.centre, ball.centre}, radius);
        const auto low = node_at(own.low), high = node_at(own.high);
        const auto spacing = float(std::clamp(2 * ball.radius / settings.across, settings.smallest, settings.largest));
        for (int i = low[0]; i <= high[0]; ++i)
            for (int j = low[1]; j <= high[1]; ++j)
                for (int k = low[2]; k <= high[2]; ++k) {
                    const Vec3 e = origin_ + step_ * Vec3{double(i), double(j), double(k)} - ball.centre;
                    if (dot(e, e) > radius * radius) continue;
                    if (float* node = find(i, j, k)) *node = spacing;
                }
    };
    for (const Ball& ball : balls) paint(ball, ball.radius + 2 * step);
    for (std::size_t n = balls.size(); n-- > 0;) paint(balls[n], balls[n].radius);
    limit_growth(settings.growth);
    for (float& node : nodes_) node = std::min(node, float(settings.largest));
}

void SpacingField::Grid::limit_growth(double growth) {
    // Half of a node's neighbours lie before it, the others behind it in the order of a sweep.
    std::vector<std::pair<std::array<int, 3>, float>> before;
    for (int n = 0; n < 13; ++n) {
        const std::array<int, 3> e{n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1};
        before.push_back({e, float(growth * step_ * std::sqrt(double(e[0] * e[0] + e[1] * e[1] + e[2] * e[2])))});
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (const int side : {1, -1})
            for (std::size_t n = 0; n < nodes_.size(); ++n) {
                const std::size_t m = side > 0 ? n : nodes_.size() - 1 - n;
                const auto& first = first_[m / cells];
                const int c = int(m % cells), i = first[0] + (c >> 6), j = first[1] + ((c >> 3) & 7),
                          k = first[2] + (c & 7);
                float least = nodes_[m];
                const auto is_inner = [](int at) { return (at & 7) > 0 && (at & 7) < 7; };
                if (is_inner(i) && is_inner(j) && is_inner(k)) {   // all in one brick
                    for (const auto& [e, rise] : before)
                        least =
                            std::min(least, (&nodes_[m])[std::ptrdiff_t(side) * (64 * e[0] + 8 * e[1] + e[2])] + rise);
                } else {
                    for (const auto& [e, rise] : before)
                        if (const float* other = find(i + side * e[0], j + side * e[1], k + side * e[2]))
                            least = std::min(least, *other + rise);
                }
                changed = changed || least < nodes_[m] * (1 - 1e-3f);
                nodes_[m] = least;
            }
    }
}

double SpacingField::operator()(const Vec3& x) const { return factor_ * grid_->at(x, settings_.smallest / factor_); }

SpacingField SpacingField::scaled(double factor) const {
    SpacingField field = *this;
    field.factor_ *= factor;
    field.settings_.smallest *= factor, field.settings_.largest *= factor, field.settings_.growth *= factor;
    field.settings_.across /= factor;
    return field;
}

namespace {

void expect_sensible(const Lumen& lumen, const SpacingSettings& settings) {
    if (!(settings.smallest > 0 && settings.largest >= settings.smallest && std::isfinite(settings.largest)))
        throw GeometryError("The smallest spacing must be positive, and the largest not below it.");
    if (!(settings.across >= 1 && settings.growth > 0 && settings.growth <= 1))
        throw GeometryError(
            "A vessel needs one spacing or more across, and a growth of the spacing above 0 and up to 1.");
    if (lumen.planar || dot(lumen.period, lumen.period) > 0)
        throw GeometryError("A spacing that follows the vessel needs a lumen in three dimensions, not a periodic one.");
    const Vec3 size = lumen.bounds.high - lumen.bounds.low;
    if (!(norm(size) < 1500 * settings.across * settings.smallest))   // 300 million nodes at the worst, of four bytes
        throw GeometryError("The smallest spacing is too small for a lumen of this size: take a larger one.");
}

/// Half the diameter that has the smallest spacing; a third of that still counts as a vessel.
double least_radius(const SpacingSettings& settings) { return 0.5 * settings.across * settings.smallest / 3; }

}   // namespace

SpacingField make_spacing_field(const Lumen& lumen, std::span<const InscribedBall> balls,
                                const SpacingSettings& settings) {
    expect_sensible(lumen, settings);
    const double least = least_radius(settings);
    std::vector<Ball> wide;
    for (const Ball& ball : balls)
        if (ball.radius >= least) wide.push_back(ball);
    if (wide.empty())
        throw GeometryError("The lumen is narrower everywhere than four of the smallest spacings: take smaller ones.");
    SpacingField field;
    field.settings_ = settings;
    field.grid_ = std::make_shared<const SpacingField::Grid>(thinned(std::move(wide), least, lumen.bounds.low),
                                                             1.5 * least, settings);
    return field;
}

SpacingField make_spacing_field(const Lumen& lumen, const SpacingSettings& settings) {
    expect_sensible(lumen, settings);
    return make_spacing_field(lumen, find_balls(lumen, least_radius(settings)), settings);
}

}   // namespace patency
