// SPDX-License-Identifier: Apache-2.0
// Fraction of the light covered by patches, added as integers: low word, high word.

// Return the covered and the visible fraction; 2^40 units are the whole light.
float share_of(uvec2 units) { return (float(units.y) * 4294967296.0 + float(units.x)) / 1099511627776.0; }
float visible_after(uvec2 units) { return units.y >= 256 ? 0.0 : 1.0 - share_of(units); }
