// Tapes, whatever they fuse and reuse, against the same expressions computed one operation at a time.

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <set>
#include <vector>

#include "surface/formula/expression.hpp"
#include "surface/formula/kernels.hpp"
#include "surface/formula/tape.hpp"
#include "surface/simd_dispatch.hpp"

namespace taut::detail {
namespace {

constexpr std::uint32_t kNumVariables = 4;  // x, y, z and a weight

/// Nodes on top of one another at random, of the operations that are fused.
Graph random_graph(std::mt19937& random, std::size_t size) {
  Graph graph;
  for (std::uint32_t i = 0; i < kNumVariables; ++i) (void)graph.variable(i);
  std::uniform_real_distribution<double> number(-2, 2);
  while (graph.size() < size) {
    const auto recent = [&] {
      const std::size_t back = std::min<std::size_t>(graph.size(), random() % 3 == 0 ? graph.size() : 4);
      return static_cast<NodeId>(graph.size() - 1 - random() % back);
    };
    const NodeId a = recent();
    const NodeId b = random() % 3 == 0 ? graph.constant(number(random)) : recent();
    switch (random() % 6) {
      case 0: (void)graph.add(a, b); break;
      case 1: (void)graph.subtract(a, b); break;
      case 2: (void)graph.subtract(b, a); break;
      case 3: (void)graph.square(a); break;
      default: (void)graph.multiply(a, b);
    }
  }
  return graph;
}

/// All nodes at one point.
std::vector<double> values_of(const Graph& graph, const double* x) {
  std::vector<double> values(graph.size());
  for (NodeId id = 0; id < graph.size(); ++id) {
    const Node& node = graph[id];
    const double a = node.op != Op::constant && node.op != Op::variable ? values[node.a] : 0;
    const double b = operand_count(node.op) > 1 ? values[node.b] : 0;
    switch (node.op) {
      case Op::constant: values[id] = node.value; break;
      case Op::variable: values[id] = x[node.a]; break;
      case Op::negate: values[id] = -a; break;
      case Op::square: values[id] = a * a; break;
      case Op::add: values[id] = a + b; break;
      case Op::subtract: values[id] = a - b; break;
      case Op::multiply: values[id] = a * b; break;
      default: ADD_FAILURE() << "an operation that is not meant to be there: " << static_cast<int>(node.op);
    }
  }
  return values;
}

TEST(FormulaTape, FusedInstructionsRoundLikeTheOperationsOneByOne) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  std::set<Code> seen;
  const InstructionSet best = instruction_set();
  for (int trial = 0; trial < 8000; ++trial) {
    const Graph graph = random_graph(random, 10 + random() % 40);
    const std::size_t n = 1 + random() % 40;
    const std::vector<std::uint32_t> sizes{1, 1 + static_cast<std::uint32_t>(random()) % 4,
                                           1 + static_cast<std::uint32_t>(random()) % (kMaxOutputRow + 4)};
    std::vector<Output> outputs;
    for (std::uint32_t array = 0; array < sizes.size(); ++array) {
      for (std::uint32_t entry = 0; entry < sizes[array]; ++entry) {
        outputs.push_back({array, entry, static_cast<NodeId>(random() % graph.size())});
      }
    }
    std::vector<double> x(3 * n);
    std::vector<double> weight(n);
    for (double& value : x) value = coordinate(random);
    for (double& value : weight) value = coordinate(random);
    std::vector<std::vector<double>> expected;
    for (const std::uint32_t size : sizes) expected.emplace_back(size * n);
    for (std::size_t j = 0; j < n; ++j) {
      const double inputs[kNumVariables] = {x[3 * j], x[3 * j + 1], x[3 * j + 2], weight[j]};
      const std::vector<double> values = values_of(graph, inputs);
      for (const Output& output : outputs) {
        expected[output.array][j * sizes[output.array] + output.entry] = values[output.node];
      }
    }
    const Tape tape = compile(graph, {{0, 3}, {3, 1}}, sizes, outputs);
    for (const Instruction& instruction : tape.instructions) seen.insert(instruction.code);
    for (const auto set :
         {InstructionSet::baseline, InstructionSet::sse4, InstructionSet::avx2, InstructionSet::avx512}) {
      if (!has_instruction_set(set)) continue;
      use_instruction_set(set);
      const std::size_t block = 16;
      struct alignas(64) Line {
        double entries[8];
      };
      std::vector<Line> slots(tape.num_slots * block / 8 + 1);
      std::vector<std::vector<double>> found;
      for (const std::uint32_t size : sizes) found.emplace_back(size * n);
      run_points(tape,
                 {.input = {x.data(), weight.data()},
                  .input_stride = {3, 1},
                  .output = {found[0].data(), found[1].data(), found[2].data()},
                  .output_stride = {sizes[0], sizes[1], sizes[2]}},
                 n, block, slots.data()->entries);
      for (std::size_t array = 0; array < sizes.size(); ++array) {
        ASSERT_EQ(std::memcmp(found[array].data(), expected[array].data(), sizeof(double) * found[array].size()), 0)
            << "trial " << trial << ", array " << array << ", instruction set " << static_cast<int>(set);
      }
    }
  }
  use_instruction_set(best);
  for (int code = static_cast<int>(Code::fused); code < kNumCodes; ++code) {
    EXPECT_TRUE(seen.contains(static_cast<Code>(code))) << code;
  }
}

}  // namespace
}  // namespace taut::detail
