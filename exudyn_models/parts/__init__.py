"""Parts for other models: friction with sensors, Exudyn's own contact, a radial support, an energy balance."""
