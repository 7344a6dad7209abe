// Cloth that crosses cloth where it starts: a garment modelled with its lapel through its front, a body that closed on
// it. The two sides cannot hold each other there, so pairs of tangled vertices with each other are left out of contact
// until nothing near them crosses any more; everything else goes on as ever. A function of the positions alone.
#pragma once

#include <span>
#include <vector>

#include "collision/crossings.h"
#include "solvers/cloth/cloth_model.h"

namespace ft {

/// Of the crossings within the cloth those that are of garments that collide with themselves.
std::vector<Crossing> own_crossings(const ClothModel& model, std::vector<Crossing> within);

/// Fills `tangled` (per cloth vertex, 0 or 1) with the vertices of these crossings and of all edges within two of them.
void mark_tangled(const ClothModel& model, std::span<const Crossing> crossings, std::vector<char>& tangled);

bool any_tangled(std::span<const char> tangled);

/// A crossing that was there when `tangled` was marked, or grew out of one.
bool among_tangled(const Crossing& crossing, std::span<const char> tangled);

}  // namespace ft
