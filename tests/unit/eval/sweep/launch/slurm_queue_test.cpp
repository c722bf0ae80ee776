#include "eval/sweep/launch/slurm_queue.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

TEST(SlurmQueue, ReadsTheTasksOfArrays) {
  const SlurmQueue queue(
      "saccade-1|0|RUNNING\n"
      "slurm_load_jobs: some warning\n"
      "saccade-1|12|PENDING\n"
      "saccade-2|0|COMPLETED\n"
      "saccade-2|N/A|CANCELLED\n");
  EXPECT_EQ(queue.state_of("saccade-1", 12), "PENDING");
  EXPECT_EQ(queue.state_of("saccade-1", 1), "");
  EXPECT_EQ(queue.state_of("saccade-3", 0), "");
  EXPECT_EQ(queue.state_of("saccade-2", 0), "COMPLETED");
  EXPECT_EQ(queue.state_of("saccade-2", 5), "CANCELLED") << "those without a line of their own";
  EXPECT_TRUE(queue.is_active("saccade-1"));
  EXPECT_FALSE(queue.is_active("saccade-2"));
  EXPECT_FALSE(queue.is_active("saccade-3"));
}

TEST(SlurmQueue, TellsStatesApart) {
  for (const char* state : {"PENDING", "RUNNING", "COMPLETING", "CONFIGURING", "SUSPENDED"})
    EXPECT_TRUE(is_active(state)) << state;
  for (const char* state : {"COMPLETED", "FAILED", "NODE_FAIL", "PREEMPTED", "TIMEOUT",
                            "OUT_OF_MEMORY", "CANCELLED", "DEADLINE"})
    EXPECT_FALSE(is_active(state)) << state;
  for (const char* lost : {"", "COMPLETED", "FAILED", "NODE_FAIL", "BOOT_FAIL", "PREEMPTED"})
    EXPECT_EQ(final_problem(lost), "") << lost;
  EXPECT_NE(final_problem("TIMEOUT").find("time limit"), std::string::npos);
  EXPECT_NE(final_problem("OUT_OF_MEMORY").find("memory"), std::string::npos);
}

}  // namespace
}  // namespace saccade
