//! From recordings to results: play, find runs, identify each as it ends.
