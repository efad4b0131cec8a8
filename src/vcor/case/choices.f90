!> Meanings of the words that a key can have, and the words of the field that lead to them: what
!> `vcor help` and the reference of the input say in addition to the catalogue
module vcor_case_choices
   use vcor_impact_shape, only : shapes
   use vcor_solver_features, only : method_table, methods
   implicit none
   private

   public :: choice_t, choices, topic_t, topics

   !> One word that a key can have
   type :: choice_t
      !> Key, `group.key`
      character(len=24) :: key
      !> The word
      character(len=16) :: word
      !> Meaning, one line
      character(len=112) :: meaning
   end type choice_t

   !> A term of the field that is not a word of input or output
   type :: topic_t
      !> Its names, lower case, between blanks
      character(len=64) :: words
      !> What it means here, and which keys have to do with it
      character(len=480) :: meaning
   end type topic_t

   integer :: i
   !> The words, in the order of the catalogue; those of units, of spacing and of yes and no explain
   !> themselves. A method that is a scheme of another is no choice of `solver.method`
   type(choice_t), parameter :: choices(*) = [ &
      (choice_t('sphere.shape', shapes(i)%name, shapes(i)%meaning), i=1, size(shapes)), &
      choice_t('plate.waves', 'none', &
         'no waves: a half space, a second sphere, a layer'), &
      choice_t('plate.waves', 'constant', &
         'thin plate, alpha(0) times the impulse: exact if elastic (Zener 1941)'), &
      choice_t('plate.waves', 'relaxing', "thin plate, alpha(t) times the impulse: the paper's"), &
      choice_t('plate.waves', 'frozen', &
         "thin plate, int alpha F' dt: the paper's Fig. 7; direct only"), &
      choice_t('plate.waves', 'hereditary', &
         'thin plate by the correspondence principle: exact if thin and wide'), &
      choice_t('plate.waves', 'body', &
         'waves and contact by full elastodynamics, any thickness: exact if wide'), &
      choice_t('plate.base', 'free', 'nothing is behind the plate'), &
      choice_t('plate.base', 'bonded', 'a layer glued to a rigid floor'), &
      choice_t('plate.base', 'sliding', 'a layer that lies on a rigid floor without friction'), &
      choice_t('target.body', 'plate', 'a thin rectangular plate, simply supported at its edges'), &
      choice_t('target.body', 'beam', 'a slender beam, struck across its length'), &
      choice_t('target.body', 'rod', 'a slender rod, struck at its end along its length'), &
      choice_t('target.body', 'block', 'a rigid block on a spring and a dashpot, or free'), &
      choice_t('target.body', 'modes', 'modes of vibration from a file, as of finite elements'), &
      choice_t('target.support', 'supported', &
         'simply supported: the edges of a plate, the ends of a beam'), &
      choice_t('target.support', 'clamped', 'both ends of a beam, the far end of a rod'), &
      choice_t('target.support', 'cantilever', 'the left end of a beam, the other one is free'), &
      choice_t('target.support', 'free', 'not held at all'), &
      choice_t('contact.mechanics', 'paper', "the paper's choices: boltzmann, eq1, relaxing"), &
      choice_t('contact.mechanics', 'exact', 'the exact choices: receding, series, body'), &
      choice_t('contact.law', 'boltzmann', &
         'hereditary integral over all the past: exact while the contact grows'), &
      choice_t('contact.law', 'receding', "Ting's rule: exact while the contact shrinks, too"), &
      choice_t('contact.pair', 'eq1', "moduli of the same time combine, the paper's Eq. (1)"), &
      choice_t('contact.pair', 'series', 'compliances add, the two bodies in series: exact'), &
      choice_t('material.model', 'rigid', 'does not deform'), &
      choice_t('material.model', 'elastic', 'one modulus'), &
      choice_t('material.model', 'sls', 'standard linear solid: E_g (a/b + (1 - a/b) exp(-b t))'), &
      choice_t('material.model', 'prony', &
         'sum of exponentials E_0 + sum E_i exp(-t/tau_i), and a dashpot'), &
      choice_t('material.model', 'power_law', 'E_0 + C t^-a/Gamma(1 - a)'), &
      choice_t('material.model', 'cerf', 'E_0 + E_1 exp(b^2 t) erfc(b sqrt(t))'), &
      choice_t('material.model', 'mittag_leffler', &
         'fractional Zener model, E_0 + E_1 E_a(-(t/tau)^a)'), &
      choice_t('material.model', 'table', 'relaxation modulus from a file'), &
      choice_t('material.modulus_kind', 'tensile', "the moduli are Young's moduli E"), &
      choice_t('material.modulus_kind', 'shear', &
         'the moduli are shear moduli G; E = 2 (1 + nu) G'), &
      choice_t('material.shift', 'wlf', &
         'Williams, Landel and Ferry: -C1 (T - T_ref)/(C2 + T - T_ref)'), &
      choice_t('material.shift', 'arrhenius', &
         'activation energy: ln a_T = (E_a/R)(1/T - 1/T_ref)'), &
      choice_t('material.shift', 'table', 'log10 a_T against T, from shift_file'), &
      choice_t('solver.method', 'auto', 'the method that suits the impact'), &
      (choice_t('solver.method', methods(i), method_table(i)%meaning), i=1, size(methods)), &
      choice_t('solver.scheme', 'product', 'product integration: order 2 to 5/2, always stable'), &
      choice_t('solver.scheme', 'adams_bashforth', "the paper's explicit scheme"), &
      choice_t('solver.form', 'a', 'by parts: the rate of u'), &
      choice_t('solver.form', 'b', 'by parts: the rate of the kernel, which must be finite at 0'), &
      choice_t('solver.quadrature', 'rectangle', "the paper's digits"), &
      choice_t('solver.quadrature', 'trapezoid', 'one order more')]

   !> The topics
   type(topic_t), parameter :: topics(*) = [ &
      topic_t(' hertz dent indentation ', &
         "Hertz's contact of curved surfaces, F = (4/3) sqrt(R) E' s^1.5. Here E' is the " &
         //'relaxation modulus of both bodies, and F an integral over the past: see ' &
         //'contact.law. sphere.shape has other bodies, plate.base layers, and the column ' &
         //'contact_ratio says how far the contact is from small.'), &
      topic_t(' layer pad mat coating sheet film glued clamped ', &
         "A layer on a rigid floor: plate.base = 'bonded' or 'sliding' with thickness. A " &
         //"plate with nothing behind it bends: plate.waves = 'body'. Columns layer_ratio, " &
         //'layer_stiffening.'), &
      topic_t(' structure edge beam bar rod anvil cantilever racket modal ', &
         'A body of finite size that is struck: the group &target. Its waves come back, and it ' &
         //'may strike the ball again: columns contacts, last_separation, structure_energy.'), &
      topic_t(' ting ', &
         "Contact that recedes: contact.law = 'receding'. T. C. T. Ting, J. Appl. Mech. " &
         //'33 (1966) 845.'), &
      topic_t(' zener ', &
         "Waves in a thin elastic plate: plate.waves = 'constant'; column inelasticity " &
         //'(lambda).'), &
      topic_t(' hardness shore durometer ', &
         'A hardness is not a modulus of an impact: it is read after seconds, while a contact of ' &
         //'a millisecond meets a stiffer material that loses more. Give moduli from DMA (vcor ' &
         //'fit, vcor master), or find them from measured impacts (vcor identify); ' &
         //'docs/materials.md has a table of moduli by hardness.'), &
      topic_t(' celsius fahrenheit ', &
         'Temperatures of a case are in K: 23 C is 296.15 K. Data may have C, and options such ' &
         //'as --reference 23C of vcor master; --celsius of vcor plot draws C.'), &
      topic_t(' rebound bounce restitution ', &
         'Velocity after the impact over that before: column cor_sphere, that of the sphere, as ' &
         //'a drop test reads it; cor, that between both bodies. resilience is cor_sphere^2, the ' &
         //'rebound of rubber laboratories; rebound_height is for a case with drop_height. vcor ' &
         //'identify reads them as data.'), &
      topic_t(' tan_delta damping ', &
         'The loss tangent: column peak_loss_tangent at pi/t0, which decides the loss, ' &
         //'loss_tangent at 2 pi/t0; peak_storage_modulus is the storage modulus at pi/t0. ' &
         //'vcor material gives all against frequency.'), &
      topic_t(' dma tts ', &
         'impact.temperature shifts the times of a material with a shift; vcor master ' &
         //'and vcor fit make one from DMA data at several temperatures.'), &
      topic_t(' friction adhesion plasticity spin ', &
         'Not computed: the contact is frictionless, linear and without adhesion. The ' &
         //'columns mean_pressure and validity say where this matters.')]

end module vcor_case_choices
