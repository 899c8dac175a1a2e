// SPDX-License-Identifier: Apache-2.0
#include "patency/schemes/cell_matrix.h"

#include <algorithm>
#include <limits>

#include "patency/base/parallel.h"

namespace patency {

double product(const CellVectors& a, const CellVectors& b) {
    return sum_of(a.size(), [&](std::size_t i) {
        const CellVector c = a[i] * b[i];
        return (double(c[0]) + double(c[1])) + (double(c[2]) + double(c[3]));
    });
}

namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t block_rows = 512;   // smoothed one after the other
constexpr std::size_t fewest_rows = 60;   // of the coarsest level
constexpr int coarsest_sweeps = 10;
constexpr int rounds = 3;   // of pairing per level: eight cells become one

struct Graph {
    std::vector<std::uint32_t> start, column;
    std::vector<float> weight;
    std::size_t size() const { return start.size() - 1; }
};

/// Each vertex with its unpaired neighbour of the largest weight. Returns the new vertex of each.
std::vector<std::uint32_t> find_pairs(const Graph& graph, std::uint32_t& count) {
    std::vector<std::uint32_t> pair(graph.size(), none);
    count = 0;
    for (std::uint32_t i = 0; i < graph.size(); ++i) {
        if (pair[i] != none) continue;
        std::uint32_t best = none;
        float largest = 0;
        for (std::uint32_t k = graph.start[i]; k < graph.start[i + 1]; ++k)
            if (const std::uint32_t j = graph.column[k]; pair[j] == none && j != i && graph.weight[k] > largest)
                best = j, largest = graph.weight[k];
        pair[i] = count;
        if (best != none) pair[best] = count;
        ++count;
    }
    return pair;
}

/// Members of each of `count` groups.
void list_members(const std::vector<std::uint32_t>& group, std::size_t count, std::vector<std::uint32_t>& start,
                  std::vector<std::uint32_t>& member) {
    start.assign(count + 1, 0);
    for (const std::uint32_t g : group) ++start[g + 1];
    for (std::size_t g = 0; g < count; ++g) start[g + 1] += start[g];
    member.resize(group.size());
    std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
    for (std::uint32_t i = 0; i < group.size(); ++i) member[next[group[i]]++] = i;
}

Graph joined_graph(const Graph& fine, const std::vector<std::uint32_t>& group, std::size_t count) {
    std::vector<std::uint32_t> start, member, place(count, none), columns;
    list_members(group, count, start, member);
    Graph coarse;
    coarse.start.assign(1, 0);
    std::vector<float> weights(count, 0);
    for (std::uint32_t g = 0; g < count; ++g) {
        columns.clear();
        for (std::uint32_t k = start[g]; k < start[g + 1]; ++k)
            for (std::uint32_t e = fine.start[member[k]]; e < fine.start[member[k] + 1]; ++e) {
                const std::uint32_t to = group[fine.column[e]];
                if (to == g) continue;
                if (place[to] != g) place[to] = g, weights[to] = 0, columns.push_back(to);
                weights[to] += fine.weight[e];
            }
        std::sort(columns.begin(), columns.end());
        for (const std::uint32_t to : columns) coarse.column.push_back(to), coarse.weight.push_back(weights[to]);
        coarse.start.push_back(std::uint32_t(coarse.column.size()));
    }
    return coarse;
}

/// Greedy colours of the runs of rows, neighbours by the matrix' entries.
std::vector<std::vector<std::uint32_t>> colour_blocks(const CellLevel& level) {
    const std::size_t blocks = (level.size() + block_rows - 1) / block_rows;
    std::vector<std::vector<std::uint32_t>> touches(blocks), colours;
    for (std::uint32_t i = 0; i < level.size(); ++i)
        for (std::uint32_t k = level.start[i]; k < level.start[i + 1]; ++k) {
            const auto a = std::uint32_t(i / block_rows), b = std::uint32_t(level.column[k] / block_rows);
            if (a != b && (touches[a].empty() || touches[a].back() != b)) touches[a].push_back(b);
        }
    std::vector<std::size_t> colour(blocks, blocks);
    for (std::uint32_t a = 0; a < blocks; ++a) {
        std::vector<char> is_taken(colours.size() + 1, 0);
        for (const std::uint32_t b : touches[a])
            if (colour[b] < is_taken.size()) is_taken[colour[b]] = 1;
        colour[a] = std::size_t(std::find(is_taken.begin(), is_taken.end(), 0) - is_taken.begin());
        if (colour[a] == colours.size()) colours.emplace_back();
        colours[colour[a]].push_back(a);
    }
    return colours;
}

void allocate(CellLevel& level, std::size_t rows) {
    level.diagonal.resize(rows);
    level.coupling.resize(level.column.size());
    level.transport.resize(level.column.size());
    level.x.resize(rows), level.b.resize(rows), level.r.resize(rows);
    level.colours = colour_blocks(level);
}

constexpr CellVector broadcast(float s) { return CellVector{s, s, s, s}; }

/// What the neighbours add to row i.
inline CellVector off_diagonal(const CellLevel& level, const CellVectors& x, std::size_t i) {
    CellVector mass{}, momentum{};
    for (std::uint32_t k = level.start[i], end = level.start[i + 1]; k < end; ++k) {
        const CellVector y = x[level.column[k]], a = level.coupling[k];
        mass += a * y;
        momentum += broadcast(level.transport[k]) * y + a * broadcast(y[0]);
    }
    momentum[0] = (mass[0] + mass[1]) + (mass[2] + mass[3]);
    return momentum;
}

inline CellVector row_times(const CellLevel& level, const CellVectors& x, std::size_t i) {
    const CellMatrixRow& d = level.diagonal[i];
    const CellVector y = x[i], div = d.divergence * y;
    CellVector sum = broadcast(d.m_diagonal) * y + d.gradient * broadcast(y[0]);
    sum[0] = d.p_diagonal * y[0] + (div[1] + div[2] + div[3]);
    return sum + off_diagonal(level, x, i);
}

/// Solves row i for its own four unknowns.
inline void relax_row(CellLevel& level, std::size_t i) {
    const CellMatrixRow& d = level.diagonal[i];
    const CellVector right = level.b[i] - off_diagonal(level, level.x, i);
    const float inverse = 1 / d.m_diagonal;
    const CellVector through = d.divergence * right, square = d.divergence * d.gradient;
    const float schur = d.p_diagonal - (square[1] + square[2] + square[3]) * inverse;
    const float p = (right[0] - (through[1] + through[2] + through[3]) * inverse) / schur;
    CellVector x = broadcast(inverse) * (right - d.gradient * broadcast(p));
    x[0] = p;
    level.x[i] = x;
}

void sweep_there_and_back(CellLevel& level) {
    const auto block = [&](std::uint32_t b, bool back) {
        const std::size_t begin = b * block_rows, end = std::min(level.size(), begin + block_rows);
        if (back)
            for (std::size_t i = end; i-- > begin;) relax_row(level, i);
        else
            for (std::size_t i = begin; i < end; ++i) relax_row(level, i);
    };
    for (const bool back : {false, true})
        for (std::size_t n = 0; n < level.colours.size(); ++n) {
            const auto& blocks = level.colours[back ? level.colours.size() - 1 - n : n];
            if (blocks.size() == 1)
                block(blocks[0], back);
            else
                for_each_task(blocks.size(), [&](std::size_t k) { block(blocks[k], back); });
        }
}

}   // namespace

CellMatrix::CellMatrix(const CellMesh& mesh) {
    Graph graph;
    graph.start = mesh.row_start;
    for (const CellNeighbour& n : mesh.row) {
        graph.column.push_back(n.cell);
        graph.weight.push_back(float(mesh.faces[n.face].conductance));
    }
    CellLevel first;
    first.start = graph.start;
    first.column = graph.column;
    first.diagonal.resize(mesh.size());
    allocate(first, mesh.size());
    levels_.push_back(std::move(first));
    while (levels_.back().size() > fewest_rows) {
        CellLevel& fine = levels_.back();
        fine.parent.resize(fine.size());
        for (std::uint32_t i = 0; i < fine.size(); ++i) fine.parent[i] = i;
        std::uint32_t count = std::uint32_t(fine.size());
        for (int round = 0; round < rounds; ++round) {
            const std::vector<std::uint32_t> pair = find_pairs(graph, count);
            graph = joined_graph(graph, pair, count);
            for (std::uint32_t& p : fine.parent) p = pair[p];
        }
        if (count > 0.8 * double(fine.size())) break;   // nothing hangs together any more
        CellLevel coarse;
        coarse.start = graph.start;
        coarse.column = graph.column;
        coarse.diagonal.resize(count);
        allocate(coarse, count);
        coarse.first.resize(count), coarse.answer.resize(count);
        list_members(fine.parent, count, coarse.child_start, coarse.child);
        fine.entry_parent.resize(fine.column.size());
        for_each_index(fine.size(), [&](std::size_t i) {
            const std::uint32_t p = fine.parent[i];
            for (std::uint32_t k = fine.start[i]; k < fine.start[i + 1]; ++k) {
                const std::uint32_t q = fine.parent[fine.column[k]];
                const auto begin = coarse.column.begin() + coarse.start[p],
                           end = coarse.column.begin() + coarse.start[p + 1];
                fine.entry_parent[k] =
                    q == p ? CellLevel::inside : std::uint32_t(std::lower_bound(begin, end, q) - coarse.column.begin());
            }
        });
        levels_.push_back(std::move(coarse));
    }
}

void CellMatrix::make_coarse() {
    for (std::size_t n = 0; n + 1 < levels_.size(); ++n) {
        const CellLevel& fine = levels_[n];
        CellLevel& coarse = levels_[n + 1];
        for_each_index(coarse.size(), [&](std::size_t p) {
            CellMatrixRow sum;
            for (std::uint32_t k = coarse.start[p]; k < coarse.start[p + 1]; ++k)
                coarse.coupling[k] = CellVector{}, coarse.transport[k] = 0;
            for (std::uint32_t c = coarse.child_start[p]; c < coarse.child_start[p + 1]; ++c) {
                const std::uint32_t i = coarse.child[c];
                const CellMatrixRow& own = fine.diagonal[i];
                sum.p_diagonal += own.p_diagonal, sum.m_diagonal += own.m_diagonal;
                sum.gradient += own.gradient, sum.divergence += own.divergence;
                for (std::uint32_t k = fine.start[i]; k < fine.start[i + 1]; ++k) {
                    const CellVector a = fine.coupling[k];
                    if (const std::uint32_t to = fine.entry_parent[k]; to != CellLevel::inside) {
                        coarse.coupling[to] += a;
                        coarse.transport[to] += fine.transport[k];
                    } else {
                        const CellVector area{0, a[1], a[2], a[3]};
                        sum.p_diagonal += a[0], sum.m_diagonal += fine.transport[k];
                        sum.gradient += area, sum.divergence += area;
                    }
                }
            }
            coarse.diagonal[p] = sum;
        });
    }
}

void CellMatrix::multiply(const CellVectors& x, CellVectors& y) const {
    const CellLevel& level = levels_.front();
    for_each_index(level.size(), [&](std::size_t i) { y[i] = row_times(level, x, i); });
}

void CellMatrix::precondition(const CellVectors& b, CellVectors& x) {
    CellLevel& level = levels_.front();
    level.b = b;
    std::fill(level.x.begin(), level.x.end(), CellVector{});
    cycle(0);
    x = level.x;
}

void CellMatrix::cycle(std::size_t n) {
    CellLevel& level = levels_[n];
    if (n + 1 == levels_.size()) {
        for (int k = 0; k < coarsest_sweeps; ++k) sweep_there_and_back(level);
        return;
    }
    sweep_there_and_back(level);
    CellLevel& coarse = levels_[n + 1];
    for_each_index(level.size(), [&](std::size_t i) { level.r[i] = level.b[i] - row_times(level, level.x, i); });
    for_each_index(coarse.size(), [&](std::size_t p) {
        CellVector sum{};
        for (std::uint32_t c = coarse.child_start[p]; c < coarse.child_start[p + 1]; ++c)
            sum += level.r[coarse.child[c]];
        coarse.b[p] = sum;
        coarse.x[p] = CellVector{};
    });
    solve_coarse(n + 1);
    for_each_index(level.size(), [&](std::size_t i) { level.x[i] += coarse.x[level.parent[i]]; });
    sweep_there_and_back(level);
}

/// x about the inverse times b by one or two cycles, each as long as leaves least: joined cells are too stiff by a factor that grows from
/// level to level, and one cycle alone would leave more of long waves the finer the cells are.          THEORY.md (18.13)
void CellMatrix::solve_coarse(std::size_t n) {
    constexpr double enough = 0.25;   // of the right side, or a second cycle follows
    CellLevel& level = levels_[n];
    cycle(n);
    if (n + 1 == levels_.size()) return;   // swept until it is solved
    CellVectors &first = level.first, &answer = level.answer;
    first.swap(level.x);
    for_each_index(level.size(), [&](std::size_t i) { answer[i] = row_times(level, first, i); });
    const double square = product(answer, answer), before = product(level.b, level.b);
    if (!(square > 0)) return level.x.swap(first);
    const double share = product(answer, level.b) / square;
    for_each_index(level.size(), [&](std::size_t i) { level.b[i] -= broadcast(float(share)) * answer[i]; });
    const double left = product(level.b, level.b);
    if (!(left > enough * enough * before)) {
        for_each_index(level.size(), [&](std::size_t i) { level.x[i] = broadcast(float(share)) * first[i]; });
        return;
    }
    std::fill(level.x.begin(), level.x.end(), CellVector{});
    cycle(n);
    CellVectors& second_answer = level.r;
    for_each_index(level.size(), [&](std::size_t i) { second_answer[i] = row_times(level, level.x, i); });
    // The second one orthogonal to the first.
    const double along = product(second_answer, answer) / square;
    const double rest = product(second_answer, second_answer) - along * along * square;
    const double second_share = rest > 1e-12 * square ? product(second_answer, level.b) / rest : 0;   // b is orthogonal to the first
    for_each_index(level.size(), [&](std::size_t i) {
        level.x[i] = broadcast(float(share - second_share * along)) * first[i] + broadcast(float(second_share)) * level.x[i];
    });
}

}   // namespace patency
