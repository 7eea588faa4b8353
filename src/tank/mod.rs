//! A simulated towing tank: scenarios in, recordings with their truth out.
