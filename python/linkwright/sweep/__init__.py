"""Many machines at once: `steady_states` in `batch`."""
