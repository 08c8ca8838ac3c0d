node base : demo_base  //! error[DRS005]: 'DRS005_unknown_kind.robot' is no model: the name ends in none of .rnd, .system, .deros
