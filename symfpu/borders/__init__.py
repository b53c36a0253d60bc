"""Where q-tori end as the energy grows: borders of series and of Newton's method, as an atlas."""
