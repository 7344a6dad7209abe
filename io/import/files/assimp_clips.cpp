// Clips: assimp's channels, in ticks, become tracks in seconds.
#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "io/import/character/pose.h"
#include "io/import/files/assimp_read.h"

namespace ft::inline io {
namespace {

double number(float x) {
  return static_cast<double>(x);
}
void append(std::vector<double>& out, const aiVector3D& v) {
  out.insert(out.end(), {number(v.x), number(v.y), number(v.z)});
}
void append(std::vector<double>& out, const aiQuaternion& q) {
  out.insert(out.end(), {number(q.x), number(q.y), number(q.z), number(q.w)});
}

template <class Key>
Track read_track(const Key* keys, unsigned count, int width, double seconds_per_tick, int& dropped) {
  Track track;
  track.width = width;
  for (unsigned i = 0; keys != nullptr && i < count; ++i) {
    const double time = keys[i].mTime * seconds_per_tick;
    if (!track.times.empty() && time <= track.times.back()) {  // NaN passes here and is refused by the check
      ++dropped;
      continue;
    }
    track.times.push_back(time);
    append(track.values, keys[i].mValue);
  }
  return track;
}

/// Morph weights: assimp names the channel after the mesh, with "*0" behind it, or after the node.
void read_morph_channel(const aiMeshMorphAnim& source, double seconds_per_tick, const Character& character, Clip& clip,
                        int& dropped) {
  std::string name = source.mName.C_Str();
  if (const auto star = name.rfind('*'); star != std::string::npos) name.resize(star);
  for (const CharacterMesh& mesh : character.meshes) {
    if (mesh.morphs.empty() || (mesh.name != name && character.nodes[static_cast<std::size_t>(mesh.node)].name != name))
      continue;
    Channel channel;
    channel.node = mesh.node;
    Track& track = channel.weights;
    track.width = static_cast<int>(mesh.morphs.size());
    for (unsigned i = 0; i < source.mNumKeys; ++i) {
      const aiMeshMorphKey& key = source.mKeys[i];
      const double time = key.mTime * seconds_per_tick;
      if (!track.times.empty() && time <= track.times.back()) {
        ++dropped;
        continue;
      }
      track.times.push_back(time);
      const std::size_t row = track.values.size();
      track.values.resize(row + mesh.morphs.size(), 0.0);
      for (unsigned k = 0; k < key.mNumValuesAndWeights; ++k)
        if (key.mValues[k] < mesh.morphs.size()) track.values[row + key.mValues[k]] = key.mWeights[k];
    }
    if (!track.empty()) clip.channels.push_back(std::move(channel));
    return;
  }
}

}  // namespace

void read_clips(const aiScene& scene, const std::vector<const aiNode*>& nodes, Character& out) {
  std::unordered_map<std::string, int> by_name;
  for (std::size_t i = 0; i < nodes.size(); ++i) by_name.emplace(nodes[i]->mName.C_Str(), static_cast<int>(i));

  int dropped = 0, unmatched = 0, repeated = 0;
  for (unsigned a = 0; a < scene.mNumAnimations; ++a) {
    const aiAnimation& animation = *scene.mAnimations[a];
    const double rate = animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : 25;
    Clip clip;
    clip.name = animation.mName.C_Str();
    if (clip.name.empty()) clip.name = "animation_" + std::to_string(a);

    std::vector<Channel> of_node(nodes.size());
    for (unsigned c = 0; c < animation.mNumChannels; ++c) {
      const aiNodeAnim& source = *animation.mChannels[c];
      const auto found = by_name.find(source.mNodeName.C_Str());
      if (found == by_name.end()) {
        ++unmatched;
        continue;
      }
      Channel& channel = of_node[static_cast<std::size_t>(found->second)];
      repeated += channel.node >= 0;
      channel.node = found->second;
      channel.translation = read_track(source.mPositionKeys, source.mNumPositionKeys, 3, 1 / rate, dropped);
      channel.rotation = read_track(source.mRotationKeys, source.mNumRotationKeys, 4, 1 / rate, dropped);
      channel.scale = read_track(source.mScalingKeys, source.mNumScalingKeys, 3, 1 / rate, dropped);
    }
    for (Channel& channel : of_node)
      if (channel.node >= 0) clip.channels.push_back(std::move(channel));
    for (unsigned m = 0; m < animation.mNumMorphMeshChannels; ++m)
      read_morph_channel(*animation.mMorphMeshChannels[m], 1 / rate, out, clip, dropped);
    clip.find_range();
    out.clips.push_back(std::move(clip));
  }
  if (dropped > 0) out.notes.push_back(std::to_string(dropped) + " keys were not later than the one before; dropped");
  if (repeated > 0)
    out.notes.push_back(std::to_string(repeated) +
                        " channels move a node that another moves, too, or nodes share a name; the last one counts");
  if (unmatched > 0) out.notes.push_back(std::to_string(unmatched) + " channels name no node; dropped");
}

}  // namespace ft::inline io
