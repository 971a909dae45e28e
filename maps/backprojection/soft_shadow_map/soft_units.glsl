// How much of the light patches cover, added up as integers: low word, high word.

// 2^40 units are the whole light.
float share_of(uvec2 units) { return (float(units.y) * 4294967296.0 + float(units.x)) / 1099511627776.0; }
float visible_after(uvec2 units) { return units.y >= 256 ? 0.0 : 1.0 - share_of(units); }
