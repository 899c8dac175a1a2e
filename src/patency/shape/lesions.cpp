// SPDX-License-Identifier: Apache-2.0
#include "patency/shape/lesions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "patency/base/median.h"

namespace patency {

namespace {

using Values = std::vector<double>;

/// What a line looks like to this file.
struct Profile {
    Values arc, diameter, area;   // area: 0 where the section says nothing of this vessel alone
    std::vector<int> branch;      // -1 in a bifurcation
    std::size_t size() const { return arc.size(); }
};

Profile profile_of(const BranchedLines& vessel, const std::vector<CrossSection>& sections, std::size_t j) {
    Profile profile;
    profile.branch = vessel.branch_ids[j];
    const auto& points = vessel.lines[j].points;
    for (std::size_t k = 0; k < points.size(); ++k) {
        profile.arc.push_back(points[k].arc);
        profile.diameter.push_back(2 * points[k].radius);
        const CrossSection& s = sections[k];
        profile.area.push_back(s.is_shared || !s.holds_place ? 0 : s.area);
    }
    return profile;
}

/// Replaces the values where `is_known` is not by straight lines between those where it is.
template <class IsKnown>
Values bridged(const Values& arc, Values values, IsKnown is_known) {
    std::size_t before = values.size();   // none
    for (std::size_t k = 0; k < values.size(); ++k) {
        if (!is_known(k)) continue;
        const std::size_t begin = before == values.size() ? 0 : before + 1;
        for (std::size_t m = begin; m < k; ++m) {
            const double t = before == values.size() ? 1 : (arc[m] - arc[before]) / (arc[k] - arc[before]);
            values[m] = before == values.size() ? values[k] : (1 - t) * values[before] + t * values[k];
        }
        before = k;
    }
    if (before != values.size()) std::fill(values.begin() + std::ptrdiff_t(before), values.end(), values[before]);
    return values;
}

/// Medians over a radius on either side, within the branch or bifurcation: what is noise goes, steps stay.
Values calmed(const Profile& p, const Values& values) {
    Values result(values.size());
    for (std::size_t k = 0; k < values.size(); ++k) {
        Values near;
        const double reach = 0.5 * values[k];
        std::size_t low = k, high = k;
        while (low > 0 && p.branch[low - 1] == p.branch[k] && p.arc[k] - p.arc[low - 1] <= reach) --low;
        while (high + 1 < values.size() && p.branch[high + 1] == p.branch[k] && p.arc[high + 1] - p.arc[k] <= reach)
            ++high;
        const std::size_t half = std::min(k - low, high - k);   // as much on either side, or a slope would shift
        for (std::size_t m = k - half; m <= k + half; ++m) near.push_back(values[m]);
        result[k] = median(std::move(near));
    }
    return result;
}

/// The level to which a valley fills: the smaller of the largest values on either side, within the reach there. (14.5)
Values filled(const Values& arc, const Values& values, double reach) {
    const auto widest = [&](std::size_t k, int step, double limit) {
        double result = values[k];
        for (std::size_t m = k + std::size_t(step); m < values.size() && std::abs(arc[m] - arc[k]) <= limit;
             m += std::size_t(step))
            result = std::max(result, values[m]);
        return result;
    };
    Values level(values.size());
    for (std::size_t k = 0; k < values.size(); ++k) {
        const double everywhere = std::min(widest(k, -1, Bounds::infinity), widest(k, +1, Bounds::infinity));
        level[k] = std::min(widest(k, -1, reach * everywhere), widest(k, +1, reach * everywhere));
    }
    return level;
}

class LineAssessor {
public:
    LineAssessor(const Profile& profile, const LesionRule& rule) : p_(profile), rule_(rule) {
        const Values bridge = bridged(p_.arc, p_.diameter, [&](std::size_t k) { return p_.branch[k] >= 0; });
        own_ = p_.diameter;   // without the bulges of bifurcations
        for (std::size_t k = 0; k < p_.size(); ++k) own_[k] = std::min(own_[k], bridge[k]);
        calm_ = calmed(p_, own_);
        level_ = filled(p_.arc, calm_, rule_.longest_half);
    }

    /// Lesions along the line, and the ranges of points they take.
    struct Found {
        Lesion lesion;
        std::size_t first, throat, last;
    };

    std::vector<Found> find() const {
        std::vector<Found> found;
        for (std::size_t begin = 0, end; begin < p_.size(); begin = end) {
            for (end = begin + 1; end < p_.size() && is_deep(end) == is_deep(begin);) ++end;
            if (!is_deep(begin)) continue;
            const Found next = lesion_around(begin, end);
            if (!next.lesion.proximal && !next.lesion.distal) continue;
            if (next.lesion.diameter_stenosis < rule_.least_stenosis || is_step(next)) continue;
            if (found.empty() || next.first > found.back().last)
                found.push_back(next);
            else if (next.lesion.minimum_diameter < found.back().lesion.minimum_diameter)   // one lesion, two throats
                found.back() = next;
        }
        return found;
    }

    Values healthy_diameter(const std::vector<Found>& found) const {
        return healthy(found, calm_, [](const Reference& r) { return r.diameter; });
    }

    Values healthy_area(const std::vector<Found>& found) const {
        const Values known = bridged(p_.arc, p_.area, [&](std::size_t k) { return p_.area[k] > 0; });
        return healthy(found, known, [](const Reference& r) { return r.area; });
    }

private:
    const Profile& p_;
    const LesionRule& rule_;
    Values own_, calm_, level_;

    bool is_deep(std::size_t k) const { return own_[k] < (1 - rule_.least_stenosis) * level_[k]; }

    /// The first point from the throat outwards beyond which, within the reference length, the lumen widens by no more
    /// than the shoulder's gain. (14.6)
    std::size_t shoulder(std::size_t throat, int step, int branch) const {
        const auto is_within = [&](std::size_t k) {
            return k < p_.size() && (p_.branch[k] == branch || p_.branch[k] < 0);
        };
        std::size_t k = throat;
        while (is_deep(k) && is_within(k + std::size_t(step))) k += std::size_t(step);   // a long throat has no slope
        for (;; k += std::size_t(step)) {
            double widest = calm_[k];
            std::size_t m = k;
            while (is_within(m + std::size_t(step)) &&
                   std::abs(p_.arc[m + std::size_t(step)] - p_.arc[k]) <= reach_at(throat))
                widest = std::max(widest, calm_[m += std::size_t(step)]);
            const bool is_in_lesion = calm_[k] * (1 + rule_.shoulder_gain) < widest;
            if (!is_in_lesion || !is_within(k + std::size_t(step))) return k;
        }
    }

    /// Medians of the branch beyond the shoulder, (14.7).
    std::optional<Reference> reference(std::size_t throat, std::size_t shoulder, int step, int branch) const {
        Values diameters, areas;
        std::size_t k = shoulder;
        for (; k < p_.size() && p_.branch[k] == branch; k += std::size_t(step)) {
            if (std::abs(p_.arc[k] - p_.arc[shoulder]) > reach_at(throat)) break;
            diameters.push_back(p_.diameter[k]);
            if (p_.area[k] > 0) areas.push_back(p_.area[k]);
        }
        if (diameters.empty()) return {};
        const double room = std::abs(p_.arc[k - std::size_t(step)] - p_.arc[shoulder]);
        const double diameter = median(diameters);
        if (room < 0.5 * diameter) return {};
        return Reference{diameter, areas.empty() ? disc(diameter) : median(areas)};
    }

    /// Whether the vessel only becomes as narrow as the branch that follows where its own one ends.
    bool is_step(const Found& f) const {
        const auto is_no_wider = [&](std::size_t shoulder, int step) {
            std::size_t k = shoulder;
            while (k < p_.size() && (p_.branch[k] < 0 || p_.branch[k] == int(f.lesion.branch))) k += std::size_t(step);
            if (k >= p_.size()) return false;
            const auto next = reference(f.throat, k, step, p_.branch[k]);
            return next && f.lesion.minimum_diameter >= (1 - rule_.least_stenosis) * next->diameter;
        };
        return (!f.lesion.proximal && is_no_wider(f.first, -1)) || (!f.lesion.distal && is_no_wider(f.last, +1));
    }

    double reach_at(std::size_t throat) const { return rule_.reference_length * level_[throat]; }

    static double disc(double diameter) { return 0.25 * std::numbers::pi * diameter * diameter; }

    Found lesion_around(std::size_t begin, std::size_t end) const {
        const auto throat = std::size_t(
            std::min_element(p_.diameter.begin() + std::ptrdiff_t(begin), p_.diameter.begin() + std::ptrdiff_t(end)) -
            p_.diameter.begin());
        std::size_t home = throat;   // in a bifurcation: the branch after it
        while (home + 1 < p_.size() && p_.branch[home] < 0) ++home;
        const int branch = p_.branch[home];
        Found f{{}, shoulder(throat, -1, branch), throat, shoulder(throat, +1, branch)};
        Lesion& lesion = f.lesion;
        lesion.branch = std::size_t(std::max(branch, 0));
        lesion.start_arc = p_.arc[f.first], lesion.throat_arc = p_.arc[throat], lesion.end_arc = p_.arc[f.last];
        lesion.minimum_diameter = p_.diameter[throat];
        lesion.minimum_area = Bounds::infinity;
        for (std::size_t k = f.first; k <= f.last; ++k)
            if (p_.area[k] > 0) lesion.minimum_area = std::min(lesion.minimum_area, p_.area[k]);
        if (std::isinf(lesion.minimum_area)) lesion.minimum_area = disc(lesion.minimum_diameter);
        lesion.proximal = reference(throat, f.first, -1, branch), lesion.distal = reference(throat, f.last, +1, branch);
        lesion.interpolated = interpolated(lesion, throat);
        lesion.diameter_stenosis = 1 - lesion.minimum_diameter / lesion.interpolated.diameter;
        lesion.area_stenosis = 1 - lesion.minimum_area / lesion.interpolated.area;
        return f;
    }

    Reference interpolated(const Lesion& lesion, std::size_t k) const {
        if (!lesion.proximal && !lesion.distal) return {level_[k], disc(level_[k])};   // it will be left out
        const Reference a = lesion.proximal ? *lesion.proximal : *lesion.distal, b = lesion.distal ? *lesion.distal : a;
        const double t = lesion.length() > 0 ? (p_.arc[k] - lesion.start_arc) / lesion.length() : 0.5;
        return {(1 - t) * a.diameter + t * b.diameter, (1 - t) * a.area + t * b.area};
    }

    template <class Of>
    Values healthy(const std::vector<Found>& found, Values values, Of of) const {
        std::vector<char> is_own(p_.size(), 1);
        for (std::size_t k = 0; k < p_.size(); ++k) is_own[k] = p_.branch[k] >= 0;
        for (const Found& f : found)
            for (std::size_t k = f.first; k <= f.last; ++k) values[k] = of(interpolated(f.lesion, k));
        return bridged(p_.arc, values, [&](std::size_t k) { return is_own[k] != 0; });   // (14.8)
    }
};

}   // namespace

Assessment assess_lesions(const BranchedLines& vessel, const std::vector<std::vector<CrossSection>>& sections,
                          const LesionRule& rule) {
    Assessment result;
    for (std::size_t j = 0; j < vessel.lines.size(); ++j) {
        const Profile profile = profile_of(vessel, sections[j], j);
        const LineAssessor assessor(profile, rule);
        const auto found = assessor.find();
        result.healthy_diameter.push_back(assessor.healthy_diameter(found));
        result.healthy_area.push_back(assessor.healthy_area(found));
        const auto& points = vessel.lines[j].points;
        std::size_t shared = 0;   // with earlier lines: what lies there is known already
        for (std::size_t i = 0; i < j; ++i) {
            const std::size_t common = shared_points(vessel.lines[i], vessel.lines[j]);
            std::copy_n(result.healthy_diameter[i].begin(), common, result.healthy_diameter[j].begin());
            std::copy_n(result.healthy_area[i].begin(), common, result.healthy_area[j].begin());
            shared = std::max(shared, common);
        }
        for (auto f : found) {
            if (f.throat < shared) continue;
            f.lesion.line = j;
            f.lesion.place = points[f.throat].place;
            result.lesions.push_back(f.lesion);
        }
    }
    std::stable_sort(result.lesions.begin(), result.lesions.end(),
                     [](const Lesion& a, const Lesion& b) { return a.diameter_stenosis > b.diameter_stenosis; });
    return result;
}

double value_at(const Centreline& line, const std::vector<double>& values, double arc) {
    const auto& p = line.points;
    const auto after = std::upper_bound(p.begin(), p.end(), arc, [](double a, const auto& q) { return a < q.arc; });
    if (after == p.begin()) return values.front();
    if (after == p.end()) return values.back();
    const auto k = std::size_t(after - p.begin());
    const double t = (arc - p[k - 1].arc) / (p[k].arc - p[k - 1].arc);
    return (1 - t) * values[k - 1] + t * values[k];
}

}   // namespace patency
