// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/cell_mixing.h"

#include <Eigen/Dense>

#include "patency/base/parallel.h"

namespace patency {

namespace {
// Of the square of each answer, all taken of one length: answers that say nearly the same share what there is to say.
constexpr double regular = 1e-8;
// Answers so many times as long as what is proposed now are of a flow too far from this one to tell its straight lines.
constexpr double far = 30;
// Of steps that leave more than `gain` of the least so far.
constexpr int patience = 15;
constexpr double gain = 0.9;
}   // namespace

void CellMixing::forget() {
    pairs_.clear(), proposed_.clear();
    least_ = INFINITY, in_vain_ = 0;
}

void CellMixing::forget_oldest() {
    pairs_.pop_front();
    for (Pair& pair : pairs_) pair.products.pop_front();
}

/// Of the last step, what it made of the proposal.
void CellMixing::learn(const CellVectors& change) {
    if (pairs_.size() == depth_) forget_oldest();
    pairs_.push_back({std::move(proposed_), std::move(made_), {}});
    Pair& last = pairs_.back();
    for_each_index(change.size(), [&](std::size_t i) {
        last.answer[i] = change[i] - last.answer[i];
        last.both[i] += last.answer[i];
    });
    for (const Pair& pair : pairs_) last.products.push_back(product(last.answer, pair.answer));
}

void CellMixing::mix(CellVectors& change, double lacking) {
    if (lacking < gain * least_)
        least_ = lacking, in_vain_ = 0;
    else if (++in_vain_ == patience)
        forget();
    if (!proposed_.empty()) learn(change);
    proposed_ = change;
    const double square = product(change, change);
    while (!pairs_.empty() && pairs_.front().products[0] > far * far * square) forget_oldest();
    if (const auto count = Eigen::Index(pairs_.size()); count > 0) {
        Eigen::MatrixXd squares(count, count);
        Eigen::VectorXd right(count);
        for (Eigen::Index a = 0; a < count; ++a) {
            const Pair& pair = pairs_[std::size_t(a)];
            for (Eigen::Index b = 0; b <= a; ++b) squares(a, b) = squares(b, a) = pair.products[std::size_t(b)];
            right(a) = product(pair.answer, proposed_);
        }
        const Eigen::ArrayXd length = squares.diagonal().array().sqrt();
        squares.array() /= (length.matrix() * length.matrix().transpose()).array();
        squares.diagonal().array() += regular;
        const Eigen::ArrayXd share = squares.ldlt().solve((right.array() / length).matrix()).array() / length;
        if (share.allFinite())
            for (Eigen::Index a = 0; a < count; ++a) {
                const CellVectors& both = pairs_[std::size_t(a)].both;
                const auto s = float(share(a));
                for_each_index(change.size(), [&](std::size_t i) { change[i] -= s * both[i]; });
            }
    }
    made_ = change;
}

}   // namespace patency
