//! The run catalogue beside the recordings, rebuilt from them at any time.
