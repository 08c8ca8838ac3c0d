node base : demo_base  //! error[DRS005]: 'DRS005_unknown_kind.robot' is not a model: its name ends in none of .rnd, .system, .deros
