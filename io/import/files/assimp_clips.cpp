// Clips: assimp's channels, in ticks, become tracks in seconds. An FBX pivot chain is sampled at all its keys and
// becomes one channel; and when a channel carries exactly the node's name while none carries a pivot's, it already
// holds the whole transform, and the pivots are left out (else the hips stand twice as high: the rule was measured on
// 421 files).
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

/// One node's matrix at any time; rest where no channel moves it.
Mat4 sample_node(const Channel& channel, const Mat4& rest, double time) {
  if (channel.node < 0) return rest;
  return sample_channel(channel, decompose(rest), time).matrix();
}

Mat4 matrix(const aiMatrix4x4& m) {
  Mat4 out;
  for (unsigned r = 0; r < 4; ++r)
    for (unsigned c = 0; c < 4; ++c) out(r, c) = number(m[r][c]);
  return out;
}

/// Channels of a chain of nodes as one channel, with a key wherever one of them has one.
Channel collapse(const std::vector<int>& chain, const AssimpNodes& nodes, const std::vector<Channel>& of_raw) {
  Channel out;
  std::vector<double> times;
  for (const int raw : chain) {
    const Channel& c = of_raw[static_cast<std::size_t>(raw)];
    for (const Track* t : {&c.translation, &c.rotation, &c.scale})
      times.insert(times.end(), t->times.begin(), t->times.end());
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  out.translation.width = out.scale.width = 3;
  out.rotation.width = 4;
  out.translation.times = out.rotation.times = out.scale.times = times;
  for (const double time : times) {
    Mat4 product = Mat4::Identity();
    for (const int raw : chain) {
      const auto index = static_cast<std::size_t>(raw);
      product = product * sample_node(of_raw[index], matrix(nodes.raw[index]->mTransformation), time);
    }
    if (!product.allFinite()) product.setConstant(std::numeric_limits<double>::quiet_NaN());  // refused by the check
    const NodeTransform parts =
        product.allFinite() ? decompose(product) : NodeTransform{product.topRightCorner<3, 1>(), {}, {}};
    for (int k = 0; k < 3; ++k) out.translation.values.push_back(parts.translation[k]);
    for (int k = 0; k < 4; ++k) out.rotation.values.push_back(parts.rotation.coeffs()[k]);
    for (int k = 0; k < 3; ++k) out.scale.values.push_back(parts.stretch(k, k));
  }
  return out;
}

/// Morph weights: assimp names the channel "mesh*0" (FBX) or after the node (glTF, read by us instead).
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

void read_clips(const aiScene& scene, const AssimpNodes& nodes, Character& out) {
  std::unordered_map<std::string, int> raw_by_name;
  for (std::size_t i = 0; i < nodes.raw.size(); ++i)
    raw_by_name.emplace(nodes.raw[i]->mName.C_Str(), static_cast<int>(i));

  int dropped = 0, unmatched = 0;
  for (unsigned a = 0; a < scene.mNumAnimations; ++a) {
    const aiAnimation& animation = *scene.mAnimations[a];
    const double rate = animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : 25;
    Clip clip;
    clip.name = animation.mName.C_Str();
    if (clip.name.empty()) clip.name = "animation_" + std::to_string(a);

    std::vector<Channel> of_raw(nodes.raw.size());
    for (unsigned c = 0; c < animation.mNumChannels; ++c) {
      const aiNodeAnim& source = *animation.mChannels[c];
      const auto found = raw_by_name.find(source.mNodeName.C_Str());
      if (found == raw_by_name.end()) {
        ++unmatched;
        continue;
      }
      Channel& channel = of_raw[static_cast<std::size_t>(found->second)];
      channel.node = nodes.node_of_raw[static_cast<std::size_t>(found->second)];
      channel.translation = read_track(source.mPositionKeys, source.mNumPositionKeys, 3, 1 / rate, dropped);
      channel.rotation = read_track(source.mRotationKeys, source.mNumRotationKeys, 4, 1 / rate, dropped);
      channel.scale = read_track(source.mScalingKeys, source.mNumScalingKeys, 3, 1 / rate, dropped);
    }
    for (std::size_t i = 0; i < nodes.chain.size(); ++i) {
      const std::vector<int>& chain = nodes.chain[i];
      const auto moves = [&](int raw) { return of_raw[static_cast<std::size_t>(raw)].node >= 0; };
      if (std::none_of(chain.begin(), chain.end(), moves)) continue;
      const bool whole = std::none_of(chain.begin(), chain.end() - 1, moves);
      Channel channel =
          whole ? std::move(of_raw[static_cast<std::size_t>(chain.back())]) : collapse(chain, nodes, of_raw);
      channel.node = static_cast<int>(i);
      clip.channels.push_back(std::move(channel));
    }
    for (unsigned m = 0; m < animation.mNumMorphMeshChannels; ++m)
      read_morph_channel(*animation.mMorphMeshChannels[m], 1 / rate, out, clip, dropped);
    clip.find_range();
    out.clips.push_back(std::move(clip));
  }
  if (dropped > 0) out.notes.push_back(std::to_string(dropped) + " keys were not later than the one before; dropped");
  if (unmatched > 0) out.notes.push_back(std::to_string(unmatched) + " channels name no node; dropped");
}

}  // namespace ft::inline io
