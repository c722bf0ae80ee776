#include "eval/sweep/launch/slurm_queue.h"

#include <gtest/gtest.h>

namespace saccade {
namespace {

TEST(SlurmQueue, ReadsTheTasksOfArrays) {
  const SlurmQueue queue(
      "saccade-1|0|RUNNING|None\n"
      "slurm_load_jobs: some warning\n"
      "saccade-1|12|PENDING|JobArrayTaskLimit\n"
      "saccade-2|0|COMPLETED|None\n"
      "saccade-2|N/A|CANCELLED|Resources\n");
  ASSERT_NE(queue.find("saccade-1", 12), nullptr);
  EXPECT_EQ(queue.find("saccade-1", 12)->reason, "JobArrayTaskLimit");
  EXPECT_TRUE(queue.find("saccade-1", 12)->is_alive());
  EXPECT_EQ(queue.find("saccade-1", 1), nullptr);
  EXPECT_EQ(queue.find("saccade-3", 0), nullptr);
  EXPECT_EQ(queue.find("saccade-2", 0)->state, "COMPLETED");
  EXPECT_EQ(queue.find("saccade-2", 5)->state, "CANCELLED") << "those without a line of their own";
  EXPECT_TRUE(queue.is_alive("saccade-1"));
  EXPECT_FALSE(queue.is_alive("saccade-2"));
  EXPECT_FALSE(queue.is_alive("saccade-3"));
}

TEST(SlurmQueue, TellsStatesApart) {
  for (const char* state : {"PENDING", "RUNNING", "COMPLETING", "CONFIGURING", "SUSPENDED"})
    EXPECT_TRUE((SlurmTask{state, ""}.is_alive())) << state;
  for (const char* state : {"COMPLETED", "FAILED", "NODE_FAIL", "PREEMPTED", "TIMEOUT",
                            "OUT_OF_MEMORY", "CANCELLED", "DEADLINE"})
    EXPECT_FALSE((SlurmTask{state, ""}.is_alive())) << state;
  for (const char* lost : {"", "COMPLETED", "FAILED", "NODE_FAIL", "BOOT_FAIL", "PREEMPTED"})
    EXPECT_EQ(final_problem(lost), "") << lost;
  EXPECT_NE(final_problem("TIMEOUT").find("time limit"), std::string::npos);
  EXPECT_NE(final_problem("OUT_OF_MEMORY").find("memory"), std::string::npos);
}

}  // namespace
}  // namespace saccade
