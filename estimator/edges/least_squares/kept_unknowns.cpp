#include "estimator/edges/least_squares/kept_unknowns.h"

#include <algorithm>
#include <functional>
#include <limits>

#include "core/check.h"

namespace saccade {

KeptUnknowns::KeptUnknowns(std::span<const std::span<double>> kept,
                           std::span<const KeptFactor> factors)
    : factors_(factors), path_blocks_(kept.front().size() / 6) {
  for (const std::span<double> values : kept) {
    const std::size_t block_size = arrays_.empty() ? 6 : values.size();
    const auto index = static_cast<std::size_t>(begin_.back());
    arrays_.push_back({values, index, static_cast<std::uint32_t>(begin_.size() - 1), block_size});
    for (std::size_t i = 0; i < values.size(); i += block_size)
      begin_.push_back(begin_.back() + static_cast<Eigen::Index>(block_size));
  }
  std::sort(arrays_.begin(), arrays_.end(), [](const Array& a, const Array& b) {
    return std::less<>()(a.values.data(), b.values.data());
  });
}

auto KeptUnknowns::place(const double* unknown) const -> Place {
  auto after = std::upper_bound(arrays_.begin(), arrays_.end(), unknown,
                                [](const double* address, const Array& array) {
                                  return std::less<>()(address, array.values.data());
                                });
  SACCADE_CHECK(after != arrays_.begin());
  const Array& array = *--after;
  const auto offset = static_cast<std::size_t>(unknown - array.values.data());
  SACCADE_CHECK(offset < array.values.size());
  return {array.block + static_cast<std::uint32_t>(offset / array.block_size),
          array.index + offset};
}

std::vector<double> KeptUnknowns::values() const {
  std::vector<double> values(static_cast<std::size_t>(begin_.back()));
  for (const Array& array : arrays_)
    std::copy(array.values.begin(), array.values.end(),
              values.begin() + static_cast<std::ptrdiff_t>(array.index));
  return values;
}

void KeptUnknowns::write(std::span<const double> values) {
  for (Array& array : arrays_)
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(array.index), array.values.size(),
                array.values.begin());
}

std::vector<std::vector<std::uint32_t>> KeptUnknowns::factor_blocks() const {
  std::vector<std::vector<std::uint32_t>> all;
  for (const KeptFactor& factor : factors_) {
    std::vector<std::uint32_t>& blocks = all.emplace_back();
    for (const double* block : factor.blocks) blocks.push_back(place(block).block);
    std::sort(blocks.begin(), blocks.end());
    blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  }
  return all;
}

double KeptUnknowns::cost(std::span<const double> values) const {
  double twice = 0;
  std::vector<const double*> parameters;
  for (const KeptFactor& factor : factors_) {
    parameters.clear();
    for (const double* block : factor.blocks)
      parameters.push_back(values.data() + place(block).index);
    Eigen::VectorXd residuals(factor.cost->num_residuals());
    if (!factor.cost->Evaluate(parameters.data(), residuals.data(), nullptr))
      return std::numeric_limits<double>::infinity();
    twice += residuals.squaredNorm();
  }
  return twice / 2;
}

void KeptUnknowns::linearise(std::span<const double> values) {
  linear_.clear();
  for (const KeptFactor& factor : factors_) linear_.push_back(linear(factor, values));
}

auto KeptUnknowns::linear(const KeptFactor& factor, std::span<const double> values) const
    -> Linear {
  Linear linear;
  const std::vector<int>& sizes = factor.cost->parameter_block_sizes();
  for (const double* block : factor.blocks) linear.blocks.push_back(place(block).block);
  std::sort(linear.blocks.begin(), linear.blocks.end());
  linear.blocks.erase(std::unique(linear.blocks.begin(), linear.blocks.end()), linear.blocks.end());
  Eigen::Index unknowns = 0;
  for (const std::uint32_t block : linear.blocks) unknowns += size(block);
  std::vector<const double*> parameters;
  std::vector<Jacobian> jacobians;
  std::vector<double*> targets;
  const int rows = factor.cost->num_residuals();
  for (std::size_t k = 0; k < factor.blocks.size(); ++k) {
    parameters.push_back(values.data() + place(factor.blocks[k]).index);
    jacobians.emplace_back(rows, sizes[k]);
  }
  for (Jacobian& jacobian : jacobians) targets.push_back(jacobian.data());
  Eigen::VectorXd residuals(rows);
  const bool is_whole = factor.cost->Evaluate(parameters.data(), residuals.data(), targets.data());
  SACCADE_CHECK(is_whole);
  // Over the unknowns of whole blocks, of which a factor may name a part.
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(rows, unknowns);
  for (std::size_t k = 0; k < factor.blocks.size(); ++k) {
    const Place at = place(factor.blocks[k]);
    Eigen::Index column = static_cast<Eigen::Index>(at.index) - begin_[at.block];
    for (const std::uint32_t block : linear.blocks) {
      if (block == at.block) break;
      column += size(block);
    }
    all.middleCols(column, sizes[k]) += jacobians[k];
  }
  linear.square = all.transpose() * all;
  linear.gradient = all.transpose() * residuals;
  return linear;
}

void KeptUnknowns::add_to(ReducedSystem& system, Eigen::VectorXd& gradient, Eigen::VectorXd& right,
                          Eigen::VectorXd& diagonal) const {
  for (const Linear& factor : linear_) {
    system.add(factor.blocks, factor.square);
    Eigen::Index local = 0;
    for (const std::uint32_t block : factor.blocks) {
      const Eigen::Index at = begin_[block], count = size(block);
      gradient.segment(at, count) += factor.gradient.segment(local, count);
      right.segment(at, count) += factor.gradient.segment(local, count);
      diagonal.segment(at, count) += factor.square.diagonal().segment(local, count);
      local += count;
    }
  }
}

}  // namespace saccade
