#pragma once

#include <functional>

#include <maximin/models/make_perturbation.hpp>
#include <maximin/models/model.hpp>
#include <maximin/proofs_check/certificate/bounds_certificate.hpp>
#include <maximin/proofs_check/certificate/certificate.hpp>
#include <maximin/proofs_check/examination.hpp>

namespace maximin {

/// What a certificate proves, in the form that campaigns, trials files and reports take: verdicts are exact and have no
/// slack, sides are shown in floating point.
Examination examination_of(const Certificate& certificate);
Examination examination_of(const BoundsCertificate& certificate);

/// What is asked of an examination, as it is asked of a certificate.
CertifyOptions certify_options(const ExaminationOptions& options);

/// The examination in exact arithmetic. Where Assumption 1 fails, or a model is too large for exact solves, the
/// verdicts say so. `certified`, if it is one, is called with the certificate as JSON. Throws InputError as `certify`,
/// and Interrupted.
Examination examine_exactly(const Model<Rational>& model, const GeometryOverrides<Rational>& overrides,
                            const ExaminationOptions& options,
                            const std::function<void(const std::string& json)>& certified = {});

}  // namespace maximin
