"""The 3D view between the columns: trajectory, cameras and playback."""
