// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/cell_mixing.h"

#include <Eigen/Dense>

#include "patency/base/parallel.h"

namespace patency {

void CellMixing::mix(CellVectors& change) {
    constexpr double regular = 1e-8;   // of the largest square: answers that say nearly the same share what there is to say
    const std::size_t size = change.size();
    if (!proposed_.empty()) {
        Pair pair{std::move(made_), std::move(proposed_)};
        for_each_index(size, [&](std::size_t i) { pair.answer[i] = change[i] - pair.answer[i]; });
        pairs_.push_back(std::move(pair));
        if (pairs_.size() > depth_) pairs_.pop_front();
    }
    proposed_ = change;
    const auto count = Eigen::Index(pairs_.size());
    if (count > 0) {
        Eigen::MatrixXd squares(count, count);
        Eigen::VectorXd right(count);
        for (Eigen::Index a = 0; a < count; ++a) {
            for (Eigen::Index b = 0; b <= a; ++b)
                squares(a, b) = squares(b, a) = product(pairs_[std::size_t(a)].answer, pairs_[std::size_t(b)].answer);
            right(a) = product(pairs_[std::size_t(a)].answer, proposed_);
        }
        squares.diagonal().array() += regular * squares.diagonal().maxCoeff();
        const Eigen::VectorXd share = squares.ldlt().solve(right);
        if (share.allFinite())
            for (Eigen::Index a = 0; a < count; ++a) {
                const Pair& pair = pairs_[std::size_t(a)];
                const auto s = float(share(a));
                for_each_index(size, [&](std::size_t i) { change[i] -= s * (pair.made[i] + pair.answer[i]); });
            }
    }
    made_ = change;
}

}   // namespace patency
