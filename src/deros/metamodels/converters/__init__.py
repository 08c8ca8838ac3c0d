"""From textX objects to typed models; textX objects end here."""
