//! What the customer gets: pages with figures, tables, the JSON contract.
