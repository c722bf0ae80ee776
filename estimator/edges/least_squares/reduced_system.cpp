#include "estimator/edges/least_squares/reduced_system.h"

#include <algorithm>
#include <utility>

namespace saccade {
namespace {

/// Dense factors are faster by an order of magnitude an operation: below this size, or above this
/// share of couplings, they win.
constexpr Eigen::Index kDenseSize = 1200;
constexpr double kDenseShare = 0.4;

/// Which blocks couple with block j: the rows of its column in the lower triangle, ascending.
std::vector<std::vector<std::uint32_t>> couplings(
    std::size_t blocks, std::span<const std::vector<std::uint32_t>> groups) {
  std::vector<std::vector<std::uint32_t>> rows(blocks);
  std::vector<std::uint32_t> merged;
  for (std::uint32_t j = 0; j < blocks; ++j) rows[j].push_back(j);
  for (const std::vector<std::uint32_t>& group : groups)
    for (auto column = group.begin(); column != group.end(); ++column) {
      std::vector<std::uint32_t>& of_column = rows[*column];
      // Most groups repeat those before.
      if (std::includes(of_column.begin(), of_column.end(), column, group.end())) continue;
      merged.clear();
      std::set_union(of_column.begin(), of_column.end(), column, group.end(),
                     std::back_inserter(merged));
      of_column = merged;
    }
  return rows;
}

}  // namespace

ReducedSystem::ReducedSystem(std::vector<Eigen::Index> begin,
                             std::span<const std::vector<std::uint32_t>> groups)
    : begin_(std::move(begin)) {
  if (size() > kDenseSize) {
    const auto coupled = couplings(begin_.size() - 1, groups);
    double entries = 0;
    for (std::size_t j = 0; j + 1 < begin_.size(); ++j)
      for (const std::uint32_t i : coupled[j])
        entries += static_cast<double>((begin_[i + 1] - begin_[i]) * (begin_[j + 1] - begin_[j]));
    const auto all = static_cast<double>(size()) * static_cast<double>(size()) / 2;
    is_dense_ = entries > kDenseShare * all;
    if (!is_dense_) make_pattern(coupled);
  }
  if (is_dense_) dense_.resize(size(), size());
}

void ReducedSystem::make_pattern(std::span<const std::vector<std::uint32_t>> coupled) {
  std::vector<Eigen::Triplet<double, Eigen::Index>> entries;
  for (std::size_t j = 0; j < coupled.size(); ++j)
    for (Eigen::Index column = begin_[j]; column < begin_[j + 1]; ++column)
      for (const std::uint32_t i : coupled[j])
        for (Eigen::Index row = std::max(begin_[i], column); row < begin_[i + 1]; ++row)
          entries.emplace_back(row, column, 1.0);
  sparse_.resize(size(), size());
  sparse_.setFromTriplets(entries.begin(), entries.end());
  sparse_.makeCompressed();
  sparse_factor_.analyzePattern(sparse_);
}

void ReducedSystem::set_zero() {
  if (is_dense_)
    dense_.setZero();
  else
    std::fill_n(sparse_.valuePtr(), sparse_.nonZeros(), 0.0);
}

void ReducedSystem::add(std::span<const std::uint32_t> blocks, const Eigen::MatrixXd& lower) {
  // Most blocks of a group follow one another: their rows are added as one. A run of them begins at
  // `global` in the system, at `local` in the group, where it goes to `end`.
  struct Run {
    Eigen::Index global, local, end;
  };
  std::vector<Run> runs;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const Eigen::Index local = runs.empty() ? 0 : runs.back().end;
    const Eigen::Index size = begin_[blocks[i] + 1] - begin_[blocks[i]];
    if (i > 0 && blocks[i] == blocks[i - 1] + 1)
      runs.back().end += size;
    else
      runs.push_back({begin_[blocks[i]], local, local + size});
  }
  for (auto own = runs.begin(); own != runs.end(); ++own)
    for (Eigen::Index column = own->local; column < own->end; ++column) {
      const Eigen::Index c = own->global + column - own->local;
      // Of the sparse column's entries, which are in order as the rows are.
      Eigen::Index at = is_dense_ ? 0 : sparse_.outerIndexPtr()[c];
      for (auto run = own; run != runs.end(); ++run) {
        const Eigen::Index row = std::max(run->local, column);
        const Eigen::Index first = run->global + row - run->local, count = run->end - row;
        double* sums = nullptr;
        if (is_dense_) {
          sums = &dense_(first, c);
        } else {
          while (sparse_.innerIndexPtr()[at] < first) ++at;
          sums = sparse_.valuePtr() + at;
          at += count;
        }
        const double* terms = &lower(row, column);
        for (Eigen::Index i = 0; i < count; ++i) sums[i] += terms[i];
      }
    }
}

void ReducedSystem::add_diagonal(const Eigen::VectorXd& diagonal) {
  if (is_dense_) {
    dense_.diagonal() += diagonal;
    return;
  }
  // The diagonal is the first entry of each column of a lower triangle.
  for (Eigen::Index i = 0; i < size(); ++i)
    sparse_.valuePtr()[sparse_.outerIndexPtr()[i]] += diagonal[i];
}

Eigen::MatrixXd ReducedSystem::matrix() const {
  if (is_dense_) return dense_.selfadjointView<Eigen::Lower>();
  return Eigen::MatrixXd(sparse_).selfadjointView<Eigen::Lower>();
}

bool ReducedSystem::factorise() {
  if (is_dense_) {
    dense_factor_.compute(dense_.selfadjointView<Eigen::Lower>());
    return dense_factor_.info() == Eigen::Success;
  }
  sparse_factor_.factorize(sparse_);
  return sparse_factor_.info() == Eigen::Success;
}

Eigen::VectorXd ReducedSystem::solve(const Eigen::VectorXd& right) const {
  return is_dense_ ? Eigen::VectorXd(dense_factor_.solve(right))
                   : Eigen::VectorXd(sparse_factor_.solve(right));
}

std::vector<Eigen::MatrixXd> ReducedSystem::inverse_blocks(std::size_t count,
                                                           std::size_t groups) const {
  std::vector<Eigen::MatrixXd> blocks;
  blocks.reserve(groups);
  const auto range = [&](std::size_t first) {
    return std::pair(begin_[first], begin_[first + count] - begin_[first]);
  };
  if (is_dense_) {
    // Only as many columns as are asked for: those of unknowns beside the path come last.
    const Eigen::Index wanted = groups == 0 ? 0 : begin_[groups - 1 + count];
    const Eigen::MatrixXd inverse = dense_factor_.solve(Eigen::MatrixXd::Identity(size(), wanted));
    for (std::size_t i = 0; i < groups; ++i) {
      const auto [first, length] = range(i);
      blocks.push_back(inverse.block(first, first, length, length));
    }
    return blocks;
  }
  const Sparse inverse = inverse_on_factor();
  const auto& order = sparse_factor_.permutationP().indices();
  for (std::size_t i = 0; i < groups; ++i) {
    const auto [first, length] = range(i);
    Eigen::MatrixXd block(length, length);
    for (Eigen::Index a = 0; a < length; ++a)
      for (Eigen::Index b = 0; b < length; ++b) {
        const Eigen::Index p = order[first + a], q = order[first + b];
        block(a, b) = inverse.coeff(std::max(p, q), std::min(p, q));
      }
    blocks.push_back(std::move(block));
  }
  return blocks;
}

auto ReducedSystem::inverse_on_factor() const -> Sparse {
  // Z = (L L^T)^-1 where L is not 0, column by column from the last:
  //   Z_ij = -1 / L_jj sum over k > j of L_kj Z_ik,  Z_jj = 1 / L_jj^2 - 1 / L_jj sum of L_kj Z_kj.
  // All Z_ik that the sum needs lie where L is not 0, too.
  const Sparse factor = sparse_factor_.matrixL();
  Sparse inverse = factor;
  const auto* outer = factor.outerIndexPtr();
  const auto* inner = factor.innerIndexPtr();
  const double* l = factor.valuePtr();
  double* z = inverse.valuePtr();
  std::vector<double> sums;
  for (Eigen::Index j = size(); j-- > 0;) {
    const Eigen::Index begin = outer[j], count = outer[j + 1] - begin;  // the diagonal first
    sums.assign(static_cast<std::size_t>(count), 0);
    for (Eigen::Index b = 1; b < count; ++b) {
      // Column k of Z, whose rows from k on include all of this column's.
      const Eigen::Index k = inner[begin + b];
      Eigen::Index at = outer[k];
      for (Eigen::Index a = b; a < count; ++a) {
        while (inner[at] < inner[begin + a]) ++at;
        sums[static_cast<std::size_t>(a)] += l[begin + b] * z[at];
        if (a != b) sums[static_cast<std::size_t>(b)] += l[begin + a] * z[at];
      }
    }
    double diagonal = 1 / (l[begin] * l[begin]);
    for (Eigen::Index a = 1; a < count; ++a) {
      z[begin + a] = -sums[static_cast<std::size_t>(a)] / l[begin];
      diagonal -= l[begin + a] * z[begin + a] / l[begin];
    }
    z[begin] = diagonal;
  }
  return inverse;
}

}  // namespace saccade
