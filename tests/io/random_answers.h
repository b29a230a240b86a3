#pragma once

#include <string>

#include "io/shard_messages.h"
#include "tests/io/random_values.h"

namespace rimod {

// What a shard may have found; name: "INDEX/COUNT" or a list of models.
inline ShardAnswer RandomAnswer(RandomValues* random, const std::string& name, int num_models,
                                int num_candidates) {
  ShardAnswer answer;
  answer.utime = 17;
  answer.scan = -123456789012345;
  answer.shard.name = name;
  if (name.find('/') != std::string::npos) {
    answer.shard.index = std::stoi(name);
    answer.shard.count = std::stoi(name.substr(name.find('/') + 1));
  }
  answer.shard.instance = random->Int(1, 1'000'000);
  answer.shard.params = random->Int(1, 1'000'000);
  answer.shard.num_models = num_models;
  answer.stage_times = {{"matching", 12.5}, {"total", 99.0}};
  JudgedScan& judged = answer.judged;
  judged.num_pixels = 10'000;
  judged.num_found = 5000;
  judged.T_local_sensor = random->Level();
  for (int m = 0; m < num_models; ++m) {
    const Eigen::Vector3d corner = random->Vector(1.0);
    judged.models.push_back(
        {"model" + std::to_string(m), corner, corner + Eigen::Vector3d(0.5, 0.6, 0.7)});
  }
  for (int i = 0; i < num_candidates; ++i) {
    ExplainingCandidate item;
    item.candidate = {random->Int(0, num_models - 1), random->Pose(), random->Between(0.0, 1.0)};
    item.rank_score = random->Between(0.0, 1.0);
    int pixel = random->Int(0, 100);
    for (int k = random->Int(0, 60); k > 0; --k) {
      const int count = random->Int(1, 9);
      item.explained.push_back({pixel, count});
      pixel += count + random->Int(1, 50);
    }
    judged.candidates.push_back(std::move(item));
  }
  return answer;
}

}  // namespace rimod
