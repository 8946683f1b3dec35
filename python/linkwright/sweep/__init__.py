"""Many machines at once: `steady_states` in `batch`; many cams: `search_cams` in `cams`."""
